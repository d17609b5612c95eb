//! Installs what a fresh machine with rustup lacks.

use std::path::Path;

use crate::Result;
use crate::command::{Call, cargo, program};
use crate::packages::TARGET;

const QEMU: &str = "qemu-system-arm";

/// Checks everything, installs what is missing, or says what to type.
pub fn run() -> Result<()> {
    component("clippy", || cargo(["clippy", "--version"]))?;
    component("rustfmt", || cargo(["fmt", "--version"]))?;
    target()?;
    qemu()
}

fn component(name: &str, check: impl Fn() -> Call) -> Result<()> {
    if check().succeeds() {
        return Ok(());
    }
    println!("installing {name}");
    let install = program("rustup", ["component", "add", name]);
    or_by_hand(install)?;
    if check().succeeds() {
        Ok(())
    } else {
        Err(format!("{name} is still missing after its installation"))
    }
}

fn target() -> Result<()> {
    if target_is_there() {
        return Ok(());
    }
    println!("installing the Rust target {TARGET}");
    or_by_hand(program("rustup", ["target", "add", TARGET]))?;
    if target_is_there() {
        Ok(())
    } else {
        Err(format!(
            "the target {TARGET} is still missing after its installation"
        ))
    }
}

/// Asks rustc, which may come from elsewhere than rustup.
fn target_is_there() -> bool {
    program("rustc", ["--print", "target-libdir", "--target", TARGET])
        .output()
        .is_ok_and(|folder| Path::new(folder.trim()).is_dir())
}

fn qemu() -> Result<()> {
    let is_there = || program(QEMU, ["--version"]).succeeds();
    if is_there() {
        return Ok(());
    }
    let by_hand =
        format!("{QEMU} is missing; install it: apt-get update && apt-get install {QEMU}");
    let Some(apt_get) = apt_get() else {
        return Err(by_hand);
    };
    println!("installing {QEMU}");
    // One unreachable source among many fails the update, and the list may be good enough.
    if let Err(error) = apt_get(&["update"]).run() {
        eprintln!("warning: {error}");
    }
    apt_get(&["install", "--yes", "--no-install-recommends", QEMU])
        .run()
        .map_err(|error| format!("{error}; {by_hand}"))?;
    if is_there() { Ok(()) } else { Err(by_hand) }
}

/// `apt-get` with the rights to install, if they can be had without asking.
fn apt_get() -> Option<impl Fn(&[&str]) -> Call> {
    if !program("apt-get", ["--version"]).succeeds() {
        return None;
    }
    let is_root = program("id", ["-u"])
        .output()
        .is_ok_and(|id| id.trim() == "0");
    if !is_root && !program("sudo", ["-n", "true"]).succeeds() {
        return None;
    }
    Some(move |words: &[&str]| {
        let call = if is_root {
            program("env", [])
        } else {
            program("sudo", ["-n", "env"])
        };
        call.words(&["DEBIAN_FRONTEND=noninteractive", "apt-get"])
            .words(words)
    })
}

fn or_by_hand(install: Call) -> Result<()> {
    let shown = install.shown().to_owned();
    install.run().map_err(|error| {
        format!("{error}; without rustup, install by your own means what `{shown}` would")
    })
}
