//! What the image makes of the encoder's edges: every one of them counted and stamped, index and switches at their place.

use leadscrew::scope::{Setup, Signal, Signals, Trigger};
use leadscrew_client::{Axis, ScopePhase};
use leadscrew_emulator::Emulator as _;

use crate::session::Board;

/// Ticks that are looked at.
const TICKS: u32 = 100;
/// Edges of a revolution.
const REVOLUTION: i64 = 10_000;
/// So slow that it stands.
const STANDS: f64 = 1e-3;

/// Count, illegal transitions, ticks with edge times lost and with such as do not explain the count, over some ticks of an encoder
/// that turns at so many edges a second, off the drive; then it stands.
fn captured(board: &Board, tool: &mut Axis, edges_per_s: f64) -> Vec<[i32; 4]> {
    let signals = [
        Signal::Count,
        Signal::IllegalTransitions,
        Signal::OverrunTicks,
        Signal::AmbiguousTicks,
    ];
    let setup = Setup {
        signals: Signals::new(&signals).unwrap(),
        every: 1,
        trigger: Trigger::Now,
        pre: 0,
        samples: TICKS,
    };
    board.machine(|machine| machine.force(edges_per_s));
    board.run_ms(10);
    tool.arm_scope(&setup).unwrap();
    let patience = std::time::Duration::from_secs(2);
    let scope = tool.wait_for_scope(patience).unwrap().expect("it ends");
    board.machine(|machine| machine.force(STANDS));
    assert_eq!(scope.phase, ScopePhase::Complete, "{scope:?}");
    let samples = tool.read_scope(&scope).unwrap();
    let whole = samples
        .iter()
        .map(|words| words.as_slice().try_into().unwrap());
    whole.collect()
}

/// Every tick of a turning encoder has its edges, and none is lost.
fn loses_no_edge(board: &Board, tool: &mut Axis, edges_per_s: f64) {
    let tick_hz = f64::from(tool.identity().tick_hz);
    let begin = captured(board, tool, STANDS)[0];
    let edges = board.machine(|machine| i64::from(machine.count()));
    let turning = captured(board, tool, edges_per_s);
    let end = captured(board, tool, STANDS)[0];
    let per_tick = edges_per_s / tick_hz;
    for pair in turning.windows(2) {
        let [before, now] = [&pair[0], &pair[1]];
        let delta = f64::from(now[0].wrapping_sub(before[0]));
        assert!((delta - per_tick).abs() <= 1.0, "{delta} of {per_tick}");
    }
    assert_eq!(begin[1..], end[1..], "illegal, overrun, ambiguous");
    let passed = board.machine(|machine| i64::from(machine.count())) - edges;
    assert_eq!(i64::from(end[0].wrapping_sub(begin[0])), passed);
    println!(
        "{edges_per_s} edges/s at {tick_hz} Hz: {passed} edges, {:?} illegal, overrun, ambiguous; {:?}",
        &end[1..],
        tool.tick_counters().unwrap()
    );
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn no_edge_is_lost_at_150_a_millisecond_and_no_tick_is_late() {
    let board = Board::blank();
    let mut tool = board.tool();
    for direction in [1.0, -1.0] {
        loses_no_edge(&board, &mut tool, 150e3 * direction);
    }
    let counters = tool.tick_counters().unwrap();
    assert_eq!((counters.late, counters.overlong), (0, 0), "{counters:?}");
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn no_edge_is_lost_at_1200_a_millisecond_and_2500_ticks_a_second() {
    let board = Board::blank();
    let mut tool = board.tool();
    // The input filter is made for the fastest edges: 72 000 mm/min and 1 000 d a mm.
    tool.edit_parameters(|edit| {
        edit.set_parameter("tick_hz", 2500.0)?;
        edit.set_parameter("motion.full_command_feed_mm_per_min", 72_000.0)
    })
    .unwrap();
    tool.save_parameters().unwrap();
    tool.restart().unwrap();
    assert_eq!(tool.identity().tick_hz, 2500);
    loses_no_edge(&board, &mut tool, 1.2e6);
    let counters = tool.tick_counters().unwrap();
    assert_eq!((counters.late, counters.overlong), (0, 0), "{counters:?}");
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn every_index_comes_a_revolution_after_the_last_one() {
    let board = Board::blank();
    let mut tool = board.tool();
    let zero = i64::from(captured(&board, &mut tool, STANDS)[0][0]);
    let offset = board.machine(|machine| i64::from(machine.count())) - zero;
    for (direction, width) in [(1.0, 0), (-1.0, 1)] {
        let before = tool.tick_counters().unwrap().indexes;
        board.machine(|machine| machine.force(100e3 * direction));
        board.run_ms(250);
        board.machine(|machine| machine.force(STANDS));
        board.run_ms(10);
        let counters = tool.tick_counters().unwrap();
        println!("{counters:?}");
        assert!((2..=3).contains(&counters.indexes.wrapping_sub(before)));
        assert_eq!(counters.index_distance.abs(), REVOLUTION, "{counters:?}");
        // Forward its front is boundary 0 of the revolution, backward that at its other end.
        let place = (counters.index_count + offset).rem_euclid(REVOLUTION);
        assert!(place <= 8 * width, "{place}");
    }
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_probe_is_latched_with_the_time_of_its_edge() {
    const TOUCHES: i32 = 5_000;
    let board = Board::blank();
    let mut tool = board.tool();
    let offset =
        captured(&board, &mut tool, STANDS)[0][0] - board.machine(|machine| machine.count());
    board.machine(|machine| {
        let touches = machine.count() + TOUCHES;
        machine.put_probe(Some(touches));
        machine.force(100e3);
    });
    board.run_ms(60);
    let words = |name: &str| -> Vec<u32> {
        board.with(|axis| {
            let (address, size) = axis.elf().symbol(name).expect(name);
            let words = (0..size / 4).filter_map(|word| axis.part().peek(address + 4 * word));
            words.collect()
        })
    };
    // The interrupt reads the count some clocks after the edge; the next edge is 840 later.
    let stamp = words("latches5PROBE");
    let count = (TOUCHES + offset).cast_unsigned();
    assert!(stamp.contains(&count), "{stamp:?}, {count}");
    let is_of_edge = |time: &u32| stamp.iter().any(|stamp| stamp.abs_diff(*time) <= 2);
    let edges = words("ring5EDGES");
    let found: Vec<_> = edges.iter().filter(|time| is_of_edge(time)).collect();
    let nearest = edges.iter().map(|edge| stamp[1].abs_diff(*edge)).min();
    assert_eq!(found.len(), 1, "{stamp:?}: {found:?}, {nearest:?}");
}
