//! The stack of the firmware: thread mode, and on top of it every handler once.
//!
//! By the frames in the image's instructions. All handlers are counted, though those of one priority do not interrupt each other.
//! Calls through pointers go wherever an address is taken, but for those that the table restricts. A panic ends in
//! the safe state, so what comes behind it does not count.

use crate::calls::{Calls, Rules, Through, Tree, words};
use crate::no_panic::{REPEATED, SIGNALS};
use crate::{Result, image};

/// Where thread mode begins; what calls it has nothing on the stack.
const THREAD: &str = "main";
/// What the processor puts on the stack of whoever is interrupted: 26 words with those of the floating-point unit, and one for alignment.
const EXCEPTION: u32 = 4 * 27;
const START: &str = "_stack_start";
const END: &str = "_stack_end";

const TASKS: &str = "embassy_executor::raw::TaskStorage<F>::poll";
const WAKERS: &str = "embassy_executor::raw::waker::";
const PORT: &str =
    "<leadscrew_app::link::bench::Bench<F> as leadscrew::protocol::service::port::Port>::";
const RECONFIGURE: &str = "<leadscrew_app::link::bench::Bench<F> as leadscrew::protocol::service::port::Port>::reconfigure";
const CHECK: &str =
    "<leadscrew_app::link::bench::Bench<F> as leadscrew::protocol::service::port::Port>::check";
const ORDER: &str =
    "<leadscrew_app::link::bench::Bench<F> as leadscrew::protocol::service::port::Port>::order";
/// Closures, whose names do not tell whose.
const CLOSURES: &str = "core::ops::function::FnOnce::call_once";

/// Calls through pointers whose callees are known.
const THROUGH: &[Through<'_>] = &[
    SIGNALS,
    Through {
        callers: &["embassy_executor::platform::thread::Executor::run"],
        callees: &[TASKS],
        reason: "the executor polls tasks",
    },
    Through {
        callers: &["SDIO", TIME],
        callees: &[WAKERS],
        reason: "handlers wake tasks of the one executor",
    },
    Through {
        callers: &["leadscrew::protocol::service::motion::"],
        callees: &[ORDER, CLOSURES],
        reason: "motion is ordered",
    },
    Through {
        callers: &["leadscrew::protocol::service::settings::"],
        callees: &[RECONFIGURE, CHECK, CLOSURES],
        reason: "settings go to the axis",
    },
    Through {
        callers: &[
            "leadscrew::protocol::service::",
            "leadscrew::protocol::decoder::Decoder<_>::feed_all",
            TASKS,
        ],
        callees: &[PORT, SENDING, SAYING, CLOSURES, WAKERS],
        reason: "requests go to the axis, and replies to the line",
    },
    Through {
        callers: &[
            SAYING,
            "=core::ops::function::FnOnce::call_once{{vtable.shim}}",
        ],
        callees: &[SENDING],
        reason: "replies go to the line, which is the end",
    },
];
/// What takes a reply, and what takes the bytes of a frame.
const SAYING: &str = "leadscrew_app::link::Link<F>::";
const SENDING: &str = "board_common::serve::Server<";
/// What makes texts: a text within a text is made of plain ones.
const FORMATTING: &str = "core::fmt::";

/// Deepest of the boot. No handler is let in yet but that of the time.
const BOOT: &[&str] = &["leadscrew_app::link::boot::Boot<"];
const TIME: &str = "TIM8_BRK_TIM12";

/// Tells the stack of thread mode and of each handler, and compares their sum with the place that the linker keeps.
pub fn check(calls: &Calls, bin: &str) -> Result<()> {
    let mut stack = Stack {
        calls,
        faults: Vec::new(),
    };
    println!("stack of `{bin}`, bytes:");
    let booting = stack.of(THREAD, &[])?;
    let running = stack.of(THREAD, BOOT)?;
    let vectors = words(&image::look(
        "llvm-objdump",
        &["-s", "-j", ".vector_table"],
        bin,
    )?);
    let mut handlers = 0;
    for handler in calls.handlers(&vectors) {
        handlers += stack.of(handler, &[])? + EXCEPTION;
    }
    let booting = booting + stack.of(TIME, &[])? + EXCEPTION;
    let running = running + handlers;
    for through in THROUGH {
        println!("  through pointers: {}", through.reason);
    }
    let place = place(&image::look("llvm-nm", &[], bin)?)?;
    println!(
        "{booting:>8} to boot, {running} to run, with {EXCEPTION} of each handler's entry; of {place}"
    );
    if !stack.faults.is_empty() {
        let faults = stack.faults.join("\n  ");
        return Err(format!("the stack of `{bin}` has no bound:\n  {faults}"));
    }
    let most = booting.max(running);
    if most > place {
        return Err(format!(
            "the stack of `{bin}` may take {most} bytes, and has {place}: make the frames above smaller"
        ));
    }
    Ok(())
}

struct Stack<'c> {
    calls: &'c Calls,
    faults: Vec<String>,
}

impl Stack<'_> {
    /// Bytes of a function and all below it.
    fn of(&mut self, root: &str, ends: &[&str]) -> Result<u32> {
        let rules = Rules {
            is_strict: false,
            through: THROUGH,
            reserved: &[TASKS, PORT, SAYING],
            ends,
            families: &[FORMATTING],
            repeated: REPEATED,
        };
        let tree = self.calls.reachable_from(root, rules)?;
        println!("{:>8} {root}", tree.stack);
        tell_deepest(&tree);
        self.faults.extend(tree.faults);
        Ok(tree.stack)
    }
}

/// Functions of less are not told.
const SMALL: u32 = 512;

fn tell_deepest(tree: &Tree) {
    for (name, bytes) in tree.deepest.iter().filter(|(_, bytes)| *bytes >= SMALL) {
        println!("         {bytes:>8} {name}");
    }
}

/// Bytes between the symbols that the linker script gives the stack.
fn place(symbols: &str) -> Result<u32> {
    let address = |wanted: &str| {
        let mut lines = symbols.lines().map(|line| line.rsplit_once(' '));
        let line = lines.find_map(|line| line.filter(|(_, name)| *name == wanted));
        let (address, _) = line.and_then(|(rest, _)| rest.split_once(' '))?;
        u32::from_str_radix(address, 16).ok()
    };
    match (address(START), address(END)) {
        (Some(start), Some(end)) if start > end => Ok(start - end),
        _ => Err(format!("the image does not say {START} and {END}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_of_the_stack_is_between_its_symbols() {
        let symbols = "10000000 A _stack_end\n080000aa t _stack\n10010000 A _stack_start\n";
        assert_eq!(place(symbols), Ok(0x1_0000));
        assert!(place("10000000 A _stack_end\n").is_err());
    }
}
