//! Any bodies in good frames into a link: `fuzz/README.md` says how to run it. What it finds is kept in
//! `corpus/service`, and replayed by `tests/protocol`.
#![no_main]

#[path = "../../tests/protocol/any_bytes.rs"]
mod any_bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    any_bytes::check_bodies(bytes);
});
