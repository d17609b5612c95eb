//! How many random cases are run: the same in every run, many more where the environment asks for a long one.

use proptest::test_runner::{Config, RngSeed};

/// So many cases, `longer` times as many where `LEADSCREW_LONG` is set.
pub fn cases(count: u32, longer: u32) -> Config {
    let is_long = std::env::var_os("LEADSCREW_LONG").is_some();
    Config {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        max_shrink_iters: 400,
        ..Config::with_cases(if is_long { longer * count } else { count })
    }
}
