//! Calibration of a probe: random probes are recovered, the minimal cases come out by hand, tables that are none are refused.

mod delay;
mod run_out;
mod stylus;

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng as _, SeedableRng as _};

/// Noise of standard deviation 1, bounded: the sum of twelve uniforms.
struct Noise(Xoshiro256PlusPlus);

impl Noise {
    fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    fn next(&mut self) -> f64 {
        let uniform = |rng: &mut Xoshiro256PlusPlus| f64::from(rng.next_u32()) / 4_294_967_296.0;
        (0..12).map(|_| uniform(&mut self.0)).sum::<f64>() - 6.0
    }
}

/// Property cases: more of them by `LEADSCREW_LONG`.
fn cases() -> u32 {
    if std::env::var_os("LEADSCREW_LONG").is_some() {
        2000
    } else {
        64
    }
}
