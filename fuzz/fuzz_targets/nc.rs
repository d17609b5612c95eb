//! Any bytes as an NC program: `cargo +nightly fuzz run nc` at the root. What it finds is kept in `corpus/nc`, and replayed by
//! `nc/tests/any_program.rs`.
#![no_main]

#[path = "../../nc/tests/support/polynomial.rs"]
mod polynomial;
#[path = "../../nc/tests/support/any_program.rs"]
mod program;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    program::check(bytes);
});
