//! What is saved stays.

use leadscrew_client::{Axis, Kind};
use leadscrew_emulator::Emulator as _;

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

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_cut_in_the_middle_of_a_write_leaves_the_old_or_the_new() {
    let board = Board::blank();
    let mut tool = board.tool();
    saved(&mut tool, 5000.0);
    drop(tool);
    let base = board;
    let mut seen = Vec::new();
    for cut_us in [300, 1_000, 3_000, 6_000, 12_000, 25_000] {
        let board = base.power_cycled();
        let mut tool = board.tool();
        tool.set_parameter(NAME, 6000.0).unwrap();
        let cut = board.with(|axis| axis.part().now()) + cut_us * 84;
        let flash = board.cut_at(cut, || tool.save_parameters());
        drop(tool);
        let found = found(&mut Board::with_flash(flash).tool());
        assert!(
            found == Some(5000.0) || found == Some(6000.0),
            "{cut_us} µs: {found:?}"
        );
        seen.push(found);
    }
    println!("{seen:?}");
}
