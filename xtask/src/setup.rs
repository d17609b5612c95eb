//! Installs what a fresh machine with rustup lacks.

use std::path::Path;

use crate::command::{Call, cargo, program, root};
use crate::packages::TARGET;
use crate::{Result, image};

const QEMU: &str = "qemu-system-arm";
const MBPOLL: &str = "mbpoll";
/// Version that the tests were written with.
const PYMODBUS: &str = "3.16.1";

/// Checks everything, installs what is missing, or says what to type.
pub fn run() -> Result<()> {
    component("clippy", || cargo(["clippy", "--version"]))?;
    component("rustfmt", || cargo(["fmt", "--version"]))?;
    llvm_tools()?;
    target()?;
    qemu()?;
    masters();
    Ok(())
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

/// They come with the toolchain; one whose components were taken apart may lack them.
fn llvm_tools() -> Result<()> {
    if image::tool_path("llvm-objdump").is_ok() {
        return Ok(());
    }
    println!("installing llvm-tools");
    or_by_hand(program("rustup", ["component", "add", "llvm-tools"]))?;
    image::tool_path("llvm-objdump").map(|_| ())
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
    debian_package(QEMU, || program(QEMU, ["--version"]).succeeds())
}

/// Modbus masters of others, which the axis's unit is tested by; without one its test says so and passes.
fn masters() {
    let has_mbpoll = || program(MBPOLL, ["-V"]).succeeds();
    for result in [debian_package(MBPOLL, has_mbpoll), pymodbus()] {
        if let Err(error) = result {
            eprintln!("warning: {error}");
        }
    }
}

/// In an environment of its own under `target`.
fn pymodbus() -> Result<()> {
    let folder = root().join("target/pymodbus");
    let folder = folder.to_string_lossy();
    let python = format!("{folder}/bin/python");
    let check = format!("import pymodbus, serial; assert pymodbus.__version__ == '{PYMODBUS}'");
    let is_there = || program(&python, ["-c", &check]).succeeds();
    if is_there() {
        return Ok(());
    }
    println!("installing pymodbus {PYMODBUS}");
    program("python3", ["-m", "venv", &folder]).run()?;
    let wanted = format!("pymodbus[serial]=={PYMODBUS}");
    program(&python, ["-m", "pip", "install", "--quiet", &wanted]).run()?;
    if is_there() {
        Ok(())
    } else {
        Err(format!(
            "pymodbus {PYMODBUS} is still missing after its installation"
        ))
    }
}

/// Installs the package of the program's name.
fn debian_package(name: &str, is_there: impl Fn() -> bool) -> Result<()> {
    if is_there() {
        return Ok(());
    }
    let by_hand =
        format!("{name} is missing; install it: apt-get update && apt-get install {name}");
    let Some(apt_get) = apt_get() else {
        return Err(by_hand);
    };
    println!("installing {name}");
    // One unreachable source among many fails the update, and the list may be good enough.
    if let Err(error) = apt_get(&["update"]).run() {
        eprintln!("warning: {error}");
    }
    apt_get(&["install", "--yes", "--no-install-recommends", name])
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
