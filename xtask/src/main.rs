//! `cargo xtask`: set-up, tests, QEMU runs, benches. What CI runs is what a person runs.
#![forbid(unsafe_code)]

mod bench;
mod calls;
mod command;
mod deny;
mod golden;
mod image;
mod licences;
mod no_panic;
mod packages;
mod rings;
mod setup;
mod size;
mod stack;
mod summary;

use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask COMMAND
  setup            install what is missing: Rust target and components, qemu-system-arm, Modbus masters
  test [--long]    set up, then everything CI checks, in rings; --long adds the long repeats
  qemu [WORD...]   run the axis in QEMU at 1000 and 2500 Hz; WORD goes to the guest
  bench [--bless]  count instructions in QEMU and compare with the golden table; --bless rewrites it
  size [--bless]   bytes of the firmware's image against the golden table; --bless rewrites it
  no-panic         prove that no panic can be reached from tick and latches, and that the stack suffices
  golden           write the tables under tests/golden anew, for review
  deny             check licences, sources and banned crates against deny.toml";

/// What went wrong, ready to be printed.
type Result<T> = std::result::Result<T, String>;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let result = match words.as_slice() {
        ["setup"] => done(setup::run()),
        ["test"] => rings::run(false),
        ["test", "--long"] => rings::run(true),
        ["qemu", guest_words @ ..] => done(qemu(guest_words)),
        ["bench"] => done(bench::run(false)),
        ["bench", "--bless"] => done(bench::run(true)),
        ["size"] => done(size::run(false)),
        ["size", "--bless"] => done(size::run(true)),
        ["no-panic"] => done(no_panic::run()),
        ["golden"] => done(golden_tables()),
        ["deny"] => done(deny::run()),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match result {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn done(result: Result<()>) -> Result<ExitCode> {
    result.map(|()| ExitCode::SUCCESS)
}

/// The tables of the tests, then that of the bench.
fn golden_tables() -> Result<()> {
    command::cargo(["test", "--package", "leadscrew"])
        .words(&[
            "--test",
            "estimators",
            "--test",
            "accuracy",
            "--test",
            "tracking",
            "--test",
            "docs",
            "--test",
            "supervisor",
            "--test",
            "protocol",
        ])
        .env("INSTA_UPDATE", "always")
        .run()?;
    command::cargo(["test", "--package", "leadscrew-host"])
        .words(&["--test", "scenarios", "documents"])
        .env("INSTA_UPDATE", "always")
        .run()?;
    command::cargo(["test", "--package", "leadscrew-host"])
        .words(&["--test", "line_faults"])
        .env("INSTA_UPDATE", "always")
        .run()?;
    command::cargo(["test", "--package", "leadscrew-app"])
        .words(&["--test", "modbus", "page"])
        .env("INSTA_UPDATE", "always")
        .run()?;
    bench::run(true)
}

fn qemu(guest_words: &[&str]) -> Result<()> {
    for tick_hz in ["tick-hz=1000", "tick-hz=2500"] {
        println!("== axis {tick_hz}");
        command::cargo([
            "run",
            "--quiet",
            "--package",
            packages::QEMU,
            "--",
            "axis",
            tick_hz,
        ])
        .words(guest_words)
        .run()?;
    }
    Ok(())
}
