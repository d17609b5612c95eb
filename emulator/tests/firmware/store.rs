//! What is saved stays.

use leadscrew_client::{Axis, Kind};
use leadscrew_emulator::{Emulator as _, MILLISECOND};

use crate::session::Board;

const NAME: &str = "motion.max_feed_mm_per_min";

fn saved(tool: &mut Axis, value: f64) {
    tool.set_parameter(NAME, value).unwrap();
    tool.save_parameters().unwrap();
}

fn found(tool: &mut Axis) -> Option<f64> {
    tool.parameter(NAME).unwrap().number()
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn what_was_saved_is_there_after_a_restart_and_after_the_power_was_off() {
    let board = Board::blank();
    let mut tool = board.tool();
    saved(&mut tool, 5000.0);
    tool.set_parameter(NAME, 4000.0).unwrap();
    tool.restart().unwrap();
    assert_eq!(found(&mut tool), Some(5000.0));
    assert!(tool.stored(Kind::Parameters).unwrap().length > 0);
    drop(tool);
    let board = board.power_cycled();
    assert_eq!(found(&mut board.tool()), Some(5000.0));
}

/// Longer than a save without an erasure: one takes 250 ms.
const ERASES_S: f64 = 0.2;

/// A board whose next save erases a sector, and what it has saved.
fn before_an_erasure() -> (Board, f64) {
    let mut board = Board::blank();
    for change in 0.. {
        assert!(change < 20, "nothing is ever erased");
        // Kept before the save, so that it can be done again.
        let before = board.power_cycled();
        let begun = board.with(|axis| axis.seconds());
        let mut tool = board.tool();
        saved(&mut tool, value(change));
        if board.with(|axis| axis.seconds()) - begun > ERASES_S {
            return (before, value(change - 1));
        }
        drop(tool);
        board = board.power_cycled();
    }
    unreachable!()
}

fn value(change: i32) -> f64 {
    5000.0 + f64::from(change)
}

/// Whatever the cut leaves, the old or the new is there, and the store goes on.
fn survives(flash: Vec<u8>, old: f64, new: f64) -> bool {
    let board = Board::with_flash(flash);
    let mut tool = board.tool();
    let value = found(&mut tool);
    assert!(value == Some(old) || value == Some(new), "{value:?}");
    saved(&mut tool, 4000.0);
    drop(tool);
    assert_eq!(found(&mut board.power_cycled().tool()), Some(4000.0));
    value == Some(new)
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_cut_in_the_middle_of_a_write_or_an_erasure_leaves_the_old_or_the_new() {
    const NEW: f64 = 6000.0;
    let (base, old) = before_an_erasure();
    let mut seen = Vec::new();
    let all = [5, 700, 15, 100, 200, 300];
    let is_long = std::env::var_os("LEADSCREW_LONG").is_some();
    let mut cuts = all[..if is_long { 6 } else { 2 }].to_vec();
    cuts.sort_unstable();
    for cut_ms in cuts {
        let board = base.power_cycled();
        let mut tool = board.tool();
        tool.set_parameter(NAME, NEW).unwrap();
        let cut = board.with(|axis| axis.part().now()) + cut_ms * MILLISECOND;
        let flash = board.cut_at(cut, || tool.save_parameters());
        drop(tool);
        seen.push(survives(flash, old, NEW));
    }
    println!("the new one: {seen:?}");
    assert!(!seen[0] && seen[seen.len() - 1], "{seen:?}");
    assert!(seen.is_sorted(), "{seen:?}");
}
