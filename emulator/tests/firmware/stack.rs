//! A stack that reached its end.

use leadscrew_emulator::Emulator as _;

use crate::session::{BOOT_MS, Board};

/// Number of the reason.
const STACK_OVERFLOW: u8 = 5;

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_stack_that_reached_its_end_is_told_after_a_restart() {
    let board = Board::blank();
    board.run_ms(BOOT_MS);
    let symbol = board.with(|axis| axis.elf().symbol("_stack_end"));
    let (end, _) = symbol.expect("the linker's symbol");
    assert_eq!(board.with(|axis| axis.part().resets()), 0);
    board.with(|axis| axis.part().poke(end + 28, 0));
    board.run_ms(2);
    assert_eq!(board.with(|axis| axis.part().resets()), 1);
    assert!(board.machine(|machine| machine.is_safe()));
    board.run_ms(BOOT_MS);
    let reset = board.tool().last_reset().unwrap();
    assert_eq!(
        (reset.reason, reset.resets),
        (STACK_OVERFLOW, 1),
        "{reset:?}"
    );
}
