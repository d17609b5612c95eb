//! Any bytes as an NC program under any correction: `fuzz/README.md` says how to run it. What it finds is kept in `corpus/nc`, and
//! replayed by `nc/tests/programs`.
#![no_main]
#![allow(dead_code, reason = "the tests that share these modules use more of them")]

#[path = "../../nc/tests/support/any_case.rs"]
mod any_case;
#[path = "../../nc/tests/support/any_program.rs"]
mod any_program;
#[path = "../../nc/tests/support/control.rs"]
mod control;
#[path = "../../nc/tests/support/motion.rs"]
mod motion;
#[path = "../../nc/tests/support/plain_words.rs"]
mod plain_words;
#[path = "../../nc/tests/support/polyline.rs"]
mod polyline;
#[path = "../../nc/tests/support/polynomial.rs"]
mod polynomial;
#[path = "../../nc/tests/support/shop.rs"]
mod shop;
#[path = "../../nc/tests/support/side_by_side.rs"]
mod side_by_side;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    any_program::check(bytes);
});
