//! Any text as a file of the process engineer's: those that the fuzzer keeps, mutated and made at random.

mod any_file;
#[path = "../../../nc/tests/support/corpus.rs"]
mod corpus;

use any_file::KINDS;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

#[test]
fn the_corpus_has_a_good_file_of_every_kind_and_all_of_it_passes() {
    let mut good = [false; KINDS.len()];
    for (path, bytes) in corpus::files("files") {
        println!("{}", path.display());
        any_file::check(&bytes);
        let kind = usize::from(bytes[0]) % KINDS.len();
        let text = String::from_utf8_lossy(&bytes[1..]);
        good[kind] |= KINDS[kind].1(&text).is_ok();
    }
    let missing: Vec<_> = KINDS
        .iter()
        .zip(good)
        .filter(|(_, good)| !good)
        .map(|((kind, _), _)| kind)
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn mutations_of_the_corpus_pass() {
    let mut count = 0;
    for bytes in corpus::mutated("files", 2000) {
        any_file::check(&bytes);
        count += 1;
    }
    assert!(count >= 2000);
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: if std::env::var_os("LEADSCREW_LONG").is_some() { 5000 } else { 256 },
        rng_seed: RngSeed::Fixed(7),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_text_passes(
        kind in 0..KINDS.len() as u8,
        text in prop_oneof![
            any::<String>(),
            "([a-z_]{1,8}|-?[0-9]{1,3}(\\.[0-9]{1,3})?|nan|inf|1e400|\"|=|,|;|\\[|\\]|\\{|\\}|#| |\n|\r\n|\u{feff}){0,60}",
        ],
    ) {
        let mut bytes = vec![kind];
        bytes.extend(text.into_bytes());
        any_file::check(&bytes);
    }
}
