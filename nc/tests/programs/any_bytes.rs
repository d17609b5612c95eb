//! Any bytes as a program: those that the fuzzer keeps, mutated and made at random.

use proptest::prelude::*;

use super::cases::cases;
use super::{any_program, corpus};

#[test]
fn every_file_of_the_corpus_passes_under_every_choice() {
    for (path, bytes) in corpus::files("nc") {
        println!("{}", path.display());
        any_program::check(&bytes);
        for choice in 0..5 * 6_u8 {
            let mut other = bytes.clone();
            for (at, by) in [choice % 5, choice % 6, choice / 6, choice / 10]
                .into_iter()
                .enumerate()
            {
                if let Some(byte) = other.get_mut(at) {
                    *byte = by;
                }
            }
            any_program::check(&other);
        }
    }
}

#[test]
fn mutations_of_the_corpus_pass() {
    let mut count = 0;
    for bytes in corpus::mutated("nc", 400) {
        any_program::check(&bytes);
        count += 1;
    }
    assert!(count >= 400);
}

proptest! {
    #![proptest_config(cases(256, 40))]

    #[test]
    fn any_bytes_pass(
        choices in any::<[u8; 4]>(),
        bytes in prop_oneof![
            proptest::collection::vec(any::<u8>(), 0..120),
            "([GXYZMNIJKRTUWFHP][0-9.+-]{0,6} ?|\r\n|\n|/|%|\\(|\\)|;|#|o){0,60}".prop_map(String::into_bytes),
            "((G(0|1|2|3|81|76|90|91|92|41|40|28|53|10|52|55)|X|Y|Z|I|J|R|U|W)(-?[0-9]{1,3}(\\.[0-9]{0,3})?)? ?\n?){0,60}"
                .prop_map(String::into_bytes),
        ],
    ) {
        let mut all = choices.to_vec();
        all.extend(bytes);
        any_program::check(&all);
    }
}
