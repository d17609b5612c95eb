//! Everything that the link can be asked for at once, while the axis moves: no tick comes late for it.

mod support;

use leadscrew::protocol::request::Request;
use leadscrew::scope::Signal;
use support::{Counters, Tool, end, linked, start};

/// Eight signals, those of two words among them.
const SIGNALS: [u8; 8] = [
    Signal::Position as u8,
    Signal::Velocity as u8,
    Signal::Acceleration as u8,
    Signal::SetpointPosition as u8,
    Signal::SetpointVelocity as u8,
    Signal::FollowingError as u8,
    Signal::Command as u8,
    Signal::Flags as u8,
];
/// Edges of a revolution of the simulated encoder.
const EDGES: u32 = 10_000;
/// The standard move.
const THERE_NM: i64 = 300_000_000;
const FEED_UM_PER_MIN: u32 = 9_000_000;

/// Ticks of a run; many where long runs are asked for.
fn ticks() -> u32 {
    if std::env::var_os("LEADSCREW_LONG").is_some() {
        100_000
    } else {
        10_000
    }
}

/// Goes to and fro for so many ticks, asking `look` in between. A move that is too late is ordered anew, as its refusal
/// says.
fn shuttle(tool: &mut Tool, feed_um_per_min: u32, ticks: u32, mut look: impl FnMut(&mut Tool)) {
    let begin = tool.tick;
    let is_over = |tool: &Tool| tool.tick - begin >= ticks;
    let mut target_nm = THERE_NM;
    while !is_over(tool) {
        let too_late = tool.heard.too_late;
        tool.ask(&Request::Move {
            target_nm,
            feed_um_per_min,
        });
        let is_there = |tool: &Tool| (tool.heard.position_nm - target_nm).abs() <= 10_000;
        while !is_there(tool) && !is_over(tool) && tool.heard.too_late == too_late {
            let seen = tool.heard.seen;
            tool.ask(&Request::RenewLease { seen });
            tool.ask(&Request::Status {});
            look(tool);
        }
        if is_there(tool) {
            target_nm = THERE_NM - target_nm;
        }
    }
}

/// An axis that tells of every tick by record and by eight signals.
fn telling(tick_hz: u32) -> (leadscrew_qemu::Guest, Tool) {
    // At 16 ns an instruction the simulated machine leaves too few of a tick of 400 µs for everything.
    let shift = if tick_hz > 1000 { 3 } else { 4 };
    let guest = linked().arg(format!("tick-hz={tick_hz}")).shift(shift);
    let (guest, mut tool) = start(&guest);
    tool.enable();
    tool.ask(&Request::Stream {
        every: 1,
        signals: &SIGNALS,
    });
    (guest, tool)
}

/// Every tick in time and told, by record and by sample.
fn all_told(tool: &mut Tool, samples_before: u32, ticks: u32) -> Counters {
    let counters = tool.counters();
    let samples = tool.heard.samples - samples_before;
    let too_late = tool.heard.too_late;
    println!(
        "{counters:?}, {samples} samples, {too_late} moves too late, at {} nm",
        tool.heard.position_nm
    );
    assert_eq!(
        (counters.late, counters.overlong, counters.lost),
        (0, 0, 0),
        "{counters:?}"
    );
    // A frame of samples may be on its way.
    assert!(samples + 20 >= ticks, "{samples} samples");
    assert_eq!((tool.heard.gaps, tool.lost()), (0, (0, 0)));
    counters
}

fn stream_delays_no_tick(tick_hz: u32) {
    let (guest, mut tool) = telling(tick_hz);
    let before = tool.heard.samples;
    shuttle(&mut tool, FEED_UM_PER_MIN, ticks(), |_| {});
    all_told(&mut tool, before, ticks());
    let log = end(&guest, &mut tool);
    assert!(log.contains("late 0 overlong 0 lost records 0"), "{log}");
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn eight_signals_of_every_tick_delay_no_tick_at_1000_hz() {
    stream_delays_no_tick(1000);
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn eight_signals_of_every_tick_delay_no_tick_at_2500_hz() {
    stream_delays_no_tick(2500);
}

/// The scope waits with a level that is compared in every tick and never reached.
#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn records_stream_and_scope_at_once_delay_no_tick() {
    let (guest, mut tool) = telling(2500);
    let before = tool.heard.samples;
    tool.ask(&Request::ArmScope {
        signals: &SIGNALS,
        every: 1,
        samples: 1000,
        before: 999,
        trigger: 4,
        source: Signal::Position as u8,
        level: i64::MAX,
    });
    shuttle(&mut tool, FEED_UM_PER_MIN, 5000, |tool| {
        tool.ask(&Request::Scope {});
        assert_eq!(tool.heard.scope, 1, "it waits for its trigger");
    });
    all_told(&mut tool, before, 5000);
    end(&guest, &mut tool);
}

/// The learner has the work memory, so that there is no scope beside it.
#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn records_stream_and_a_learner_at_once_delay_no_tick() {
    let (guest, mut tool) = telling(1000);
    let before = tool.heard.samples;
    tool.ask(&Request::Learn { edges: EDGES });
    // More than the travel has: it averages to the end.
    let feed_um_per_min = 3_000_000;
    let mut is_running = false;
    shuttle(&mut tool, feed_um_per_min, 5000, |tool| {
        if tool.heard.position_nm > 20_000_000 && !is_running {
            is_running = true;
            tool.ask(&Request::LearnRun { revolutions: 100 });
        }
        tool.ask(&Request::Learning {});
    });
    println!("learned {:?}", tool.heard.learned);
    all_told(&mut tool, before, 5000);
    assert!(tool.heard.learned.0 > 5, "{:?}", tool.heard.learned);
    end(&guest, &mut tool);
}
