//! Any bytes as a program: those that the fuzzer keeps, and random ones.

#[path = "support/polynomial.rs"]
mod polynomial;
#[path = "support/any_program.rs"]
mod support;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

#[test]
fn every_file_of_the_corpus_passes() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../fuzz/corpus/nc");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        support::check(&std::fs::read(entry.unwrap().path()).unwrap());
        count += 1;
    }
    assert!(count >= 5, "{count} files in {folder}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: if std::env::var_os("LEADSCREW_LONG").is_some() { 5000 } else { 128 },
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_bytes_pass(
        bytes in prop_oneof![
            proptest::collection::vec(any::<u8>(), 0..120),
            "([GXYZMNIJKRTUWFHP][0-9.+-]{0,6} ?|\r\n|\n|/|%|\\(|\\)|;|#|o){0,60}".prop_map(String::into_bytes),
            "((G(0|1|2|3|81|76|90|91|92|41|40|28|53|10|52|55)|X|Y|Z|I|J|R|U|W)(-?[0-9]{1,3}(\\.[0-9]{0,3})?)? ?\n?){0,60}"
                .prop_map(String::into_bytes),
        ],
    ) {
        support::check(&bytes);
    }
}
