//! Any text as a file that the process engineer's commands read: `fuzz/README.md` says how to run it. What it finds is kept in
//! `corpus/files`, and replayed by `process/tests/any_files`.
#![no_main]

#[path = "../../process/tests/any_files/any_file.rs"]
mod any_file;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    any_file::check(bytes);
});
