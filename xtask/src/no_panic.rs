//! No panic in the tick and in the latches of the axis board, proven twice.
//!
//! By the linker: `tick_only` is their handlers in the profile of the firmware; its panic handler calls a symbol that is
//! nowhere defined, so it links only if no panic can be reached. With a panic planted it must not link: else the proof proves nothing.
//!
//! By the calls of the firmware that is flashed: no panic, no trap, no recursion but what is named here, and through pointers only
//! to functions that are looked at too. The image with the planted panic, linked after all, must be found out.
//! The stack of thread mode and all handlers at once must have its place.

use crate::calls::{Calls, Rules, Through, words};
use crate::command::{Call, cargo};
use crate::packages::{AXIS_BOARD, TARGET};
use crate::{Result, image, stack};

const BIN: &str = "tick_only";
const FIRMWARE: &str = "firmware";
const FEATURE: &str = "tick-only";
const PLANTED: &str = "tick-only,planted-panic";
/// What the panic handler of the image calls.
const NOWHERE: &str = "a_panic_is_reachable_from_the_tick";
const DISASSEMBLE: &[&str] = &["-d", "-C", "--no-show-raw-insn"];
/// The tick; the stamps of probe and home; the direction of steps.
const ROOTS: &[&str] = &["TIM8_UP_TIM13", "TIM1_CC", "EXTI9_5"];
/// No panic, no trap, nothing unknown.
const RULES: Rules<'_> = Rules {
    is_strict: true,
    through: &[SIGNALS],
    reserved: &[],
    ends: &[],
    families: &[],
    repeated: REPEATED,
};
/// The readers are constant functions without captures, chosen when the scope is set up. All such functions of the image are looked at.
pub const SIGNALS: Through<'_> = Through {
    callers: &[
        "leadscrew::scope::Scope::record",
        "leadscrew::scope::trigger::Watch::sees",
        "leadscrew::scope::stream::Stream::take",
    ],
    callees: &["=core::ops::function::FnOnce::call_once"],
    reason: "readers of the scope's signals",
};
/// Functions that call themselves, and how often they are on the stack at most.
pub const REPEATED: &[(&str, u32)] = &[
    // A subnormal number is scaled up, and is none then.
    ("libm::math::frexp::frexp", 2),
];

/// Builds the images, and looks at the calls of the one that is flashed.
pub fn run() -> Result<()> {
    links_without_panic()?;
    does_not_link_with_panic()?;
    a_planted_panic_is_found()?;
    image::build(AXIS_BOARD, FIRMWARE, &[])?;
    let calls = calls_of(FIRMWARE)?;
    let faults = look(&calls)?;
    if !faults.is_empty() {
        return Err(format!(
            "tick or latches of `{FIRMWARE}` are not as they must be:\n  {}",
            faults.join("\n  ")
        ));
    }
    stack::check(&calls, FIRMWARE)
}

fn links_without_panic() -> Result<()> {
    let (text, result) = build(FEATURE).watch();
    result.map_err(|error| {
        if text.contains(NOWHERE) {
            format!(
                "a panic can be reached from the tick or the latches: the calls of `{FIRMWARE}` tell from where"
            )
        } else {
            error
        }
    })
}

fn does_not_link_with_panic() -> Result<()> {
    let (text, result) = build(PLANTED).watch();
    match result {
        Ok(()) => Err(format!(
            "`{BIN}` links with a planted panic: the proof proves nothing"
        )),
        Err(_) if text.contains(NOWHERE) => Ok(()),
        Err(error) => Err(format!("{error}, but not for its panic:\n{text}")),
    }
}

/// The image is linked by giving the symbol a place.
fn a_planted_panic_is_found() -> Result<()> {
    let place = format!("link-arg=--defsym={NOWHERE}=0x101");
    cargo(["rustc", "--quiet", "--package", AXIS_BOARD])
        .words(&["--target", TARGET, "--profile", "firmware"])
        .words(&["--bin", BIN, "--features", PLANTED])
        .words(&["--", "-C", &place])
        .run()?;
    let faults = look(&calls_of(BIN)?)?;
    if faults.iter().any(|fault| fault.contains("core::panicking")) {
        println!("a planted panic is found, by the linker and by the calls");
        Ok(())
    } else {
        Err(format!(
            "the calls of `{BIN}` with a planted panic tell nothing of it: the proof proves nothing; they tell {faults:?}"
        ))
    }
}

fn build(features: &str) -> Call {
    cargo(["build", "--quiet", "--package", AXIS_BOARD])
        .words(&["--target", TARGET, "--profile", "firmware"])
        .words(&["--bin", BIN, "--features", features])
}

fn calls_of(bin: &str) -> Result<Calls> {
    let constants = image::look("llvm-objdump", &["-s", "-j", ".rodata", "-j", ".data"], bin)?;
    let text = image::look("llvm-objdump", DISASSEMBLE, bin)?;
    Calls::read(&text, &words(&constants))
}

/// What is wrong with the handlers; tells what they are made of.
fn look(calls: &Calls) -> Result<Vec<String>> {
    let mut faults = Vec::new();
    for root in ROOTS {
        let tree = calls.reachable_from(root, RULES)?;
        println!(
            "{root}: {} functions, {} bytes of stack, {} faults",
            tree.functions,
            tree.stack,
            tree.faults.len()
        );
        faults.extend(tree.faults);
    }
    Ok(faults)
}
