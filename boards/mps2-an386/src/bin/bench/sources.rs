//! The sources of setpoints other than planned moves, and the second encoder at 1 000 rpm.

use board_mps2_an386::instructions::Counter;
use leadscrew::hal::{Capture, Latch, Reference};
use leadscrew::params::AxisConfig;
use leadscrew::setpoint::sources::{Source, Sources};
use leadscrew::setpoint::thread::{SpindleWay, ThreadOrder, ThreadPhase};
use leadscrew::supervisor::Permit;
use leadscrew::units::{Command, Position};
use leadscrew_hal_mock::scenario::ScenarioError;
use static_cell::ConstStaticCell;

use crate::samples::Samples;
use crate::standard_move::{config, estimators};

const TICKS: u32 = 3000;
/// Ticks in which the spindle turns before a pass is armed.
const WARM_UP: u32 = 200;
/// Counts of the spindle in a tick, and in a revolution.
const EDGES: usize = 68;
const PER_TURN: u32 = 4096;
/// Clocks of a tick.
const CLOCKS: u32 = 84_000;

const NAMES: [&str; 6] = [
    "master", "step_dir", "analog", "gearing", "thread", "run_in",
];
static TABLE: ConstStaticCell<[Samples; NAMES.len()]> =
    ConstStaticCell::new(Samples::of_each(&NAMES));

pub fn run(counter: &mut Counter) -> Result<(), ScenarioError> {
    let table = TABLE.take();
    let config = config(estimators()?[0])?.0;
    for (source, place) in [
        (Source::StepDir, 1),
        (Source::Analog, 2),
        (Source::Gearing, 3),
    ] {
        follow(counter, &config, source, table, place);
    }
    cut(counter, &config, table);
    for samples in table {
        samples.log("sources");
    }
    Ok(())
}

fn follow(
    counter: &mut Counter,
    config: &AxisConfig,
    source: Source,
    table: &mut [Samples],
    place: usize,
) {
    let mut sources = Sources::new(&config.limits, &config.sources);
    if sources.select(source).is_err() {
        return;
    }
    for tick in 0..TICKS {
        let cost = step(counter, &mut sources, tick, &mut table[0]);
        if tick == WARM_UP {
            let _ = sources.engage(true);
        }
        if tick > 2 * WARM_UP {
            table[place].push(cost);
        }
    }
}

fn cut(counter: &mut Counter, config: &AxisConfig, table: &mut [Samples]) {
    let order = ThreadOrder {
        lead_mm: 2.0,
        start_mm: 1.0,
        from_mm: 10.0,
        to_mm: 60.0,
        angle_deg: 30.0,
        starts: 1,
        start: 0,
        spindle: SpindleWay::Forward,
        retract_deg: 90.0,
    };
    let mut sources = Sources::new(&config.limits, &config.sources);
    for tick in 0..TICKS {
        let cost = step(counter, &mut sources, tick, &mut table[0]);
        if tick == WARM_UP {
            let _ = sources.arm_thread(&order, Position::ZERO, tick);
        }
        match sources.thread_phase() {
            ThreadPhase::Cutting => table[4].push(cost),
            ThreadPhase::RunIn | ThreadPhase::RunOut => table[5].push(cost),
            _ => (),
        }
    }
}

/// One tick; what the source costs without the second encoder, whose cost goes to `master`.
fn step(counter: &mut Counter, sources: &mut Sources, tick: u32, master: &mut Samples) -> u32 {
    let now = tick.wrapping_mul(CLOCKS);
    let mut edges = [0; EDGES];
    for (place, edge) in edges.iter_mut().enumerate() {
        let age = (EDGES - place) as u32 * (CLOCKS / EDGES as u32);
        *edge = now.wrapping_sub(age);
    }
    let count = tick * EDGES as u32;
    let turn = count / PER_TURN * PER_TURN;
    let capture = Capture {
        count,
        sampled_at: now,
        last_edge_at: edges.last().copied(),
        edges: [&edges, &[]],
        index: (count - turn < EDGES as u32).then_some(Latch {
            count: turn,
            time: now,
        }),
        ..Capture::default()
    };
    let reference = Reference {
        steps: tick * 37,
        analog: Command::from_bits(((tick / 500) << 26) as i32),
        ..Reference::default()
    };
    let read = counter.count(|| sources.read_master(Some(&capture), false));
    if tick > WARM_UP {
        master.push(read);
    }
    counter.count(|| sources.step(tick, &reference, Permit::Follow).position)
}
