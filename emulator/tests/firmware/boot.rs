//! From a blank flash on.

use leadscrew_emulator::PutOut;

use crate::session::{BOOT_MS, Board};

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_blank_board_boots_into_the_safe_state() {
    let board = Board::blank();
    board.run_ms(BOOT_MS);
    board.machine(|machine| {
        assert!(machine.is_safe());
        assert_eq!(machine.take_put_out(), PutOut::default());
        // It speaks to the converter in every tick.
        let (frames, broken) = machine.converter().frames();
        assert!(frames > 200 && broken == 0, "{frames}, {broken}");
    });
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_tool_learns_what_the_board_is_and_how_it_stands() {
    let board = Board::blank();
    let mut tool = board.tool();
    let identity = tool.identity().clone();
    assert_eq!(identity.tick_hz, 1000);
    assert!(identity.can_set() && identity.can_record(), "{identity:?}");
    let status = tool.status().unwrap();
    assert!(!status.is_enabled, "{status:?}");
    assert_eq!(status.fault_number, 0, "{status:?}");
    assert_eq!(
        board.with(|axis| leadscrew_emulator::Emulator::resets(axis.part())),
        0
    );
    let counters = tool.tick_counters().unwrap();
    assert!(counters.ticks > 10, "{counters:?}");
    assert_eq!((counters.late, counters.lost_records), (0, 0));
}

/// Longest time from power-on to the first answer of a board whose observer's gains are to be solved for, s: less than a
/// tool waits for it.
const LONGEST_BOOT_S: f64 = 10.0;

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_board_with_an_observer_answers_while_a_tool_waits_for_it() {
    if std::env::var_os("LEADSCREW_LONG").is_none() {
        return;
    }
    let board = Board::blank();
    let mut tool = board.tool();
    tool.set_word("estimator", "observer").unwrap();
    tool.save_parameters().unwrap();
    drop(tool);
    let board = board.power_cycled();
    let mut tool = board.tool();
    let boot_s = board.with(|axis| axis.seconds());
    println!("the first answer after {boot_s:.2} s");
    assert_eq!(tool.tick_counters().unwrap().late, 0);
    assert!(boot_s < LONGEST_BOOT_S, "{boot_s} s");
}
