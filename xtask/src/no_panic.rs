//! No panic in the tick, proven by the linker.
//!
//! `tick_only` is the tick in the profile of the firmware; its panic handler calls a symbol that is nowhere defined, so
//! it links only if no panic can be reached. With a panic planted it must not link: else the proof proves nothing.
//! Then the image's calls are looked at: none but those that are named here may go through a pointer, and the stack of the deepest way is told.

use crate::calls::Calls;
use crate::command::cargo;
use crate::packages::{PROOF, TARGET};
use crate::{Result, image};

const BIN: &str = "tick_only";
const PLANTED: &str = "planted-panic";
/// What the panic handler of the image calls.
const NOWHERE: &str = "a_panic_is_reachable_from_the_tick";
/// Functions that may call through a pointer, and why.
const THROUGH_POINTERS: &[(&str, &str)] = &[
    ("leadscrew::scope::Scope::record", SIGNALS),
    ("leadscrew::scope::trigger::Watch::sees", SIGNALS),
    ("leadscrew::scope::stream::Stream::take", SIGNALS),
];
/// Whoever takes their addresses has them linked: no panic is in them. Their stack is not in the sum.
const SIGNALS: &str = "the readers of the scope's signals, leaves in a constant table";
const DISASSEMBLE: &[&str] = &["-d", "-C", "--no-show-raw-insn"];
/// Where the tick begins.
const TICK: &str = "SysTick";

/// Builds both images and looks at the calls of the one that links.
pub fn run() -> Result<()> {
    links_without_panic()?;
    does_not_link_with_panic()?;
    let calls = Calls::read(&image::look("llvm-objdump", DISASSEMBLE, BIN)?)?;
    let tree = calls.reachable_from(TICK, THROUGH_POINTERS)?;
    if !tree.faults.is_empty() {
        return Err(format!(
            "the tick of `{BIN}` is not as it must be:\n  {}",
            tree.faults.join("\n  ")
        ));
    }
    println!(
        "no panic can be reached from the tick: {} functions; stack at most {} bytes",
        tree.functions, tree.stack
    );
    for (name, reason) in THROUGH_POINTERS {
        println!("  {name} calls through pointers: {reason}");
    }
    Ok(())
}

fn links_without_panic() -> Result<()> {
    let (text, result) = build(&[]).watch();
    result.map_err(|error| {
        if text.contains(NOWHERE) {
            format!(
                "a panic can be reached from the tick; to see from where, build `{BIN}` with \
                 `-- -C link-arg=--defsym={NOWHERE}=0x101` and look for calls of core::panicking"
            )
        } else {
            error
        }
    })
}

fn does_not_link_with_panic() -> Result<()> {
    let (text, result) = build(&["--features", PLANTED]).watch();
    match result {
        Ok(()) => Err(format!(
            "`{BIN}` links with a planted panic: the proof proves nothing"
        )),
        Err(_) if text.contains(NOWHERE) => Ok(()),
        Err(error) => Err(format!("{error}, but not for its panic:\n{text}")),
    }
}

fn build(words: &[&str]) -> crate::command::Call {
    cargo(["build", "--package", PROOF, "--target", TARGET])
        .words(&["--profile", "firmware", "--bin", BIN])
        .words(words)
}
