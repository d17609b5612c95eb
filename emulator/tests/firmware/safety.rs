//! What becomes of an axis in motion whose firmware fails.

use leadscrew_client::{Axis, LastReset};
use leadscrew_emulator::Emulator as _;

use crate::motion::set_up;
use crate::session::{BOOT_MS, Board};

/// Control register of the tick's timer.
const TICK_TIMER: u32 = 0x4001_0400;
/// Number of the tick's exception.
const TICK: u16 = 60;
/// Where the tests put what a panic points to: in the work memory.
const LOCATION: u32 = 0x1000_0100;
/// Where there is no memory.
const NOWHERE: u32 = 0x6000_0000;
/// Reasons of a reset.
const PANIC: u8 = 1;
const HARD_FAULT: u8 = 2;
const WATCHDOG: u8 = 3;
/// Longest time from a failure to outputs that are safe: the watchdog's at its slowest, and a tick.
const LONGEST_MS: u64 = 11;

/// An axis in motion.
fn moving() -> (Board, Axis) {
    let board = Board::blank();
    let mut tool = board.tool();
    set_up(&mut tool);
    tool.enable().unwrap();
    tool.jog(3000.0).unwrap();
    tool.wait(std::time::Duration::from_millis(300)).unwrap();
    let (is_enabled, command) = board.machine(|machine| (machine.relays().0, machine.command()));
    assert!(is_enabled && command.abs() > 0.1, "{is_enabled} {command}");
    (board, tool)
}

/// The outputs are safe soon, the part starts anew once, the axis can be used again and tells why.
fn is_safe_and_comes_back(board: &Board, within_ms: u64) -> LastReset {
    board.run_ms(within_ms);
    assert!(board.machine(|machine| machine.is_safe()));
    board.machine(|machine| machine.take_put_out());
    board.run_ms(BOOT_MS);
    assert_eq!(board.with(|axis| axis.part().resets()), 1);
    let put_out = board.machine(|machine| machine.take_put_out());
    assert!(!put_out.enabled && !put_out.brake_released, "{put_out:?}");
    let mut tool = board.tool();
    assert!(!tool.status().unwrap().is_enabled);
    let reset = tool.last_reset().unwrap();
    assert_eq!(reset.resets, 1, "{reset:?}");
    reset
}

/// Lets time pass until the core handles the tick.
fn into_the_tick(board: &Board) {
    for _ in 0..2_000 {
        board.with(|axis| axis.run(1_680).unwrap());
        if board.with(|axis| axis.part().exception()) == TICK {
            return;
        }
    }
    panic!("there is no tick");
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn the_watchdog_ends_a_tick_that_does_not_come() {
    let (board, _tool) = moving();
    board.with(|axis| axis.part().poke(TICK_TIMER, 0));
    let reset = is_safe_and_comes_back(&board, LONGEST_MS);
    assert_eq!(reset.reason, WATCHDOG, "{reset:?}");
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn the_watchdog_ends_a_tick_that_hangs() {
    let (board, _tool) = moving();
    into_the_tick(&board);
    let loops = board.with(|axis| {
        let mut addresses = 0x0801_0000_u32..0x0808_0000;
        let is_loop = |&address: &u32| {
            axis.part().peek(address & !3).is_some_and(|word| {
                let half = if address & 2 == 0 { word } else { word >> 16 };
                half as u16 == 0xe7fe
            })
        };
        addresses.by_ref().step_by(2).find(is_loop)
    });
    let address = loops.unwrap_or_else(|| {
        // No loop in the program: one in RAM.
        board.with(|axis| axis.part().poke(LOCATION, 0xe7fe_e7fe));
        LOCATION
    });
    board.with(|axis| axis.part().jump(address, &[]));
    let reset = is_safe_and_comes_back(&board, LONGEST_MS);
    assert_eq!(reset.reason, WATCHDOG, "{reset:?}");
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_panic_is_safe_at_once() {
    let (board, _tool) = moving();
    let (address, _) = board
        .with(|axis| axis.elf().symbol("panic_bounds_check"))
        .expect("a program that can panic");
    board.with(|axis| {
        // File, its length, line, column; then the file's name: "t.rs".
        let words = [LOCATION + 16, 4, 4711, 1, 0x7372_2e74];
        for (place, word) in (0_u32..).zip(words) {
            axis.part().poke(LOCATION + 4 * place, word);
        }
        axis.part().jump(address, &[7, 3, LOCATION]);
    });
    let reset = is_safe_and_comes_back(&board, 1);
    assert_eq!((reset.reason, reset.place), (PANIC, 4711), "{reset:?}");
    assert_eq!(reset.file, "t.rs");
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_hard_fault_is_safe_at_once() {
    let (board, _tool) = moving();
    board.with(|axis| axis.part().jump(NOWHERE, &[]));
    let reset = is_safe_and_comes_back(&board, 1);
    assert_eq!(
        (reset.reason, reset.place),
        (HARD_FAULT, NOWHERE),
        "{reset:?}"
    );
    assert_ne!(reset.status[0], 0, "{reset:?}");
}
