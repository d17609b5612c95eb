//! Instructions of the tick in the image that is flashed, from its handler's first to its return: a golden table.
//!
//! They are instructions, not cycles, and none of a core that waits for the flash. Latches and other interrupts that come
//! meanwhile are not in them; the loops that wait for the converter are, and turn as often as the model of the core has it.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Duration;

use leadscrew::scope::{Setup, Signal, Signals, Trigger};
use leadscrew_client::Axis;
use leadscrew_emulator::Emulator as _;

use crate::motion::set_up;
use crate::session::Board;

const GOLDEN: &str = "tests/golden/tick_instructions.txt";
/// The same stages in QEMU, without the board around them.
const IN_QEMU: &str = "tests/golden/bench.txt";
const HEAD: &str = "\
# Instructions of the tick in the image of the STM32F4 board at 1 kHz, from the handler's first to its return, counted on
# the emulated part (they are not cycles). Sampling of all inputs and the exchange with the converter are in them, so they are
# more than those of `link/tick` in bench.txt, which QEMU counts.
# Written by the test of the emulator's firmware with LEADSCREW_BLESS set; it fails on a change of more than 2 %.
";
/// Instructions by which a row may change with the compiler's choice of registers alone.
const REGISTERS: u32 = 4;
/// Ticks of a row: so many times so many, each within the time of a lease.
const WINDOWS: usize = 4;
const WINDOW_MS: u64 = 50;

/// A row: what the axis does, median, worst.
type Row = (&'static str, u32, u32);

/// Counts ticks while the axis goes on as it does.
fn row(board: &Board, tool: &mut Axis, name: &'static str) -> Row {
    let (handler, _) = board
        .with(|axis| axis.elf().symbol("TIM8_UP_TIM13"))
        .expect("the tick's handler");
    let mut counts = Vec::new();
    for _ in 0..WINDOWS {
        // The lease is renewed.
        tool.wait(Duration::from_millis(20)).unwrap();
        board.with(|axis| {
            axis.part().count_calls(Some(handler));
            axis.run_ms(WINDOW_MS).expect("it runs");
            counts.extend(axis.part().calls());
            axis.part().count_calls(None);
        });
    }
    let ticks = WINDOWS * WINDOW_MS as usize;
    assert!(counts.len() + WINDOWS >= ticks, "{} ticks", counts.len());
    counts.sort_unstable();
    (name, counts[counts.len() / 2], counts[counts.len() - 1])
}

fn rows() -> Vec<Row> {
    let board = Board::blank();
    let mut tool = board.tool();
    let mut rows = vec![row(&board, &mut tool, "disabled")];
    set_up(&mut tool);
    tool.enable().unwrap();
    rows.push(row(&board, &mut tool, "standing"));
    tool.jog(9000.0).unwrap();
    tool.wait(Duration::from_millis(300)).unwrap();
    rows.push(row(&board, &mut tool, "jog_9000_mm_per_min"));
    let signals = [
        Signal::Count,
        Signal::Position,
        Signal::Velocity,
        Signal::Acceleration,
        Signal::SetpointPosition,
        Signal::SetpointVelocity,
        Signal::FollowingError,
        Signal::Command,
    ];
    let setup = Setup {
        signals: Signals::new(&signals).unwrap(),
        every: 1,
        trigger: Trigger::Force,
        pre: 0,
        samples: 100,
    };
    tool.arm_scope(&setup).unwrap();
    rows.push(row(&board, &mut tool, "jog_with_scope_of_8"));
    assert_eq!(tool.status().unwrap().fault_number, 0);
    rows
}

fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(name)
}

fn text(rows: &[Row]) -> String {
    let mut text = format!("{HEAD}{:<24} {:>8} {:>8}\n", "state", "median", "worst");
    for (name, median, worst) in rows {
        // A string takes all that is written.
        let _ = writeln!(text, "{name:<24} {median:>8} {worst:>8}");
    }
    text
}

/// Median and worst of a row of a golden table.
fn golden(table: &str, name: &str) -> Option<(u32, u32)> {
    let mut rows = table.lines().map(str::split_whitespace);
    let mut row = rows.find_map(|mut row| (row.next() == Some(name)).then_some(row))?;
    Some((row.next()?.parse().ok()?, row.next()?.parse().ok()?))
}

/// More than 2 %, and more than what registers take.
fn has_changed(old: u32, new: u32) -> bool {
    let by = old.abs_diff(new);
    by * 50 > old && by > REGISTERS
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn the_tick_takes_the_instructions_that_it_took() {
    let rows = rows();
    let text = text(&rows);
    println!("{text}");
    let qemu = std::fs::read_to_string(file(IN_QEMU)).unwrap();
    for stage in ["link/tick", "link/tick_scope", "step/exponential"] {
        println!("QEMU {stage:<19} {:?}", golden(&qemu, stage));
    }
    if std::env::var_os("LEADSCREW_BLESS").is_some() {
        std::fs::write(file(GOLDEN), &text).unwrap();
    }
    let table = std::fs::read_to_string(file(GOLDEN)).unwrap_or_default();
    for (name, median, worst) in rows {
        let (old_median, old_worst) = golden(&table, name)
            .unwrap_or_else(|| panic!("{name} is not in {GOLDEN}; LEADSCREW_BLESS writes it"));
        assert!(
            !has_changed(old_median, median) && !has_changed(old_worst, worst),
            "{name}: {old_median}, {old_worst} were {GOLDEN}'s, now {median}, {worst}"
        );
    }
}

#[test]
fn a_change_of_more_than_two_percent_is_one() {
    assert!(!has_changed(2000, 2040) && !has_changed(2000, 1960));
    assert!(has_changed(2000, 2041) && has_changed(2000, 1959));
    assert!(!has_changed(100, 104) && has_changed(100, 105));
}
