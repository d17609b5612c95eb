//! The simulated machine: its step has to leave room for the tick at 1 and at 2.5 kHz.

use board_mps2_an386::instructions::Counter;
use leadscrew::axis::{Inputs, Outputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Encoder as _;
use leadscrew::telemetry::Record;
use leadscrew::units::{AxisScale, Command};
use leadscrew_hal_mock::arc::{Arc, State};
use leadscrew_hal_mock::carriage::Carriage;
use leadscrew_hal_mock::drive::Drive;
use leadscrew_hal_mock::encoder::Encoder;
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::{MoveAndBack, ScenarioError, Setup};
use leadscrew_hal_mock::trace::TraceDigest;
use static_cell::ConstStaticCell;

use crate::samples::Samples;

const SEED: u64 = 1;
/// The standard move at 2.5 kHz has more ticks than are kept; on a shorter way it is as fast.
const MOVE_MM: f64 = 100.0;
/// Ticks of a stage that is not a move.
const TICKS: u32 = 1000;
/// Ticks between reversals of the shuttle: up to 50 d/tick at 1 kHz.
const SHUTTLE: u32 = 48;

struct Table {
    moving: [Samples; 2],
    resting: [Samples; 2],
    digests: [Samples; 2],
    shuttle: Samples,
    turning: Samples,
    drive: Samples,
    carriage: Samples,
    edge: Samples,
}

static TABLE: ConstStaticCell<Table> = ConstStaticCell::new(Table {
    moving: [Samples::of("machine_1000hz"), Samples::of("machine_2500hz")],
    resting: [Samples::of("resting_1000hz"), Samples::of("resting_2500hz")],
    digests: [Samples::of("digest_1000hz"), Samples::of("digest_2500hz")],
    shuttle: Samples::of("shuttle_1000hz"),
    turning: Samples::of("turning"),
    drive: Samples::of("drive"),
    carriage: Samples::of("carriage"),
    edge: Samples::of("edge"),
});

pub fn run(counter: &mut Counter) -> Result<(), ScenarioError> {
    let table = TABLE.take();
    for (rate, tick_hz) in [1000.0, 2500.0].into_iter().enumerate() {
        let (moving, resting) = (&mut table.moving[rate], &mut table.resting[rate]);
        there_and_back(counter, tick_hz, moving, resting, &mut table.digests[rate])?;
        moving.log("simulator");
        resting.log("simulator");
        table.digests[rate].log("simulator");
    }
    shuttle(counter, &mut table.shuttle)?;
    turning(counter, &mut table.turning)?;
    parts(counter, &mut table.drive, &mut table.carriage)?;
    edge(counter, &mut table.edge)?;
    for samples in [
        &mut table.shuttle,
        &mut table.turning,
        &mut table.drive,
        &mut table.carriage,
        &mut table.edge,
    ] {
        samples.log("simulator");
    }
    Ok(())
}

/// Machine and digest over a move there and back in closed loop, as the firmware runs them.
fn there_and_back(
    counter: &mut Counter,
    tick_hz: f64,
    moving: &mut Samples,
    resting: &mut Samples,
    digests: &mut Samples,
) -> Result<(), ScenarioError> {
    let scenario = MoveAndBack {
        move_mm: MOVE_MM,
        ..MoveAndBack::standard(tick_hz)
    };
    let estimator = EstimatorConfig::by_name("exponential")?.expect("it is in the list");
    let Setup {
        mut machine,
        mut axis,
        script,
    } = Setup::new(&scenario, &MachineParams::z_16k20f3(), estimator, SEED)?;
    let mut digest = TraceDigest::new();
    let mut applied = Outputs::default();
    let mut moves = script.moves.iter().peekable();
    for tick in 0..script.ticks {
        if let Some(next) = moves.next_if(|next| next.start == tick) {
            let _ = axis.queue(&next.profile, next.start);
        }
        let step = counter.count(|| machine.step(applied.command, applied.enabled));
        let inputs = Inputs::of(machine.capture(), true);
        applied = *axis.step(&inputs);
        let record = Record::new(&applied);
        let hashed = counter.count(|| digest.update(&inputs, &record));
        if applied.moving {
            moving.push(step);
            digests.push(hashed);
        } else {
            resting.push(step);
        }
    }
    Ok(())
}

/// The machine at the limit of its acceleration to and fro: it turns round in one tick of a few.
fn shuttle(counter: &mut Counter, samples: &mut Samples) -> Result<(), ScenarioError> {
    let mut machine = Machine::new(&MachineParams::z_16k20f3(), 1000.0, SEED)?;
    for tick in 0..TICKS {
        let forward = (tick / SHUTTLE).is_multiple_of(2);
        let command = if forward { Command::MAX } else { Command::MIN };
        samples.push(counter.count(|| machine.step(command, true)));
    }
    Ok(())
}

/// The encoder on a shaft that swings so slowly for its acceleration that it may turn in every tick.
fn turning(counter: &mut Counter, samples: &mut Samples) -> Result<(), ScenarioError> {
    const ACCELERATION: f64 = 2.1;
    let mut encoder = Encoder::new(&MachineParams::z_16k20f3().encoder, 1000.0, 0.5, SEED)?;
    let mut state = State {
        position: 0.5,
        velocity: 0.0,
        acceleration: ACCELERATION,
    };
    for _ in 0..TICKS {
        let arc = Arc {
            start: state,
            jerk: 0.0,
        };
        samples.push(counter.count(|| encoder.advance(&arc)));
        state = arc.end();
        if state.velocity.abs() > 4.0 * ACCELERATION {
            state.acceleration = -state.velocity.signum() * ACCELERATION;
        }
    }
    Ok(())
}

/// What the machine costs without its encoder.
fn parts(
    counter: &mut Counter,
    drives: &mut Samples,
    carriages: &mut Samples,
) -> Result<(), ScenarioError> {
    let params = MachineParams::z_16k20f3();
    let scale = AxisScale::new(params.mount.counts_per_mm, 1000.0)?;
    let mut drive = Drive::new(&params.drive, scale, 0.5)?;
    let mut carriage = Carriage::new(&params.carriage, scale, 0.5)?;
    for _ in 0..TICKS {
        drives.push(counter.count(|| drive.step(Command::from_num(0.94), true)));
        let shaft = drive.shaft();
        carriages.push(counter.count(|| carriage.step(shaft)));
    }
    Ok(())
}

/// What an edge costs the encoder: a tick with 150 less one without, over the edges.
fn edge(counter: &mut Counter, samples: &mut Samples) -> Result<(), ScenarioError> {
    const VELOCITY: f64 = 150.0;
    let mut encoder = Encoder::new(&MachineParams::z_16k20f3().encoder, 1000.0, 0.5, SEED)?;
    let mut position = 0.5;
    for _ in 0..TICKS {
        let mut advance = |velocity| {
            let start = State {
                position,
                velocity,
                acceleration: 0.0,
            };
            position += velocity;
            let arc = Arc { start, jerk: 0.0 };
            let cost = counter.count(|| encoder.advance(&arc));
            let [older, newer] = encoder.capture().edges;
            (cost, (older.len() + newer.len()) as u32)
        };
        let (dear, edges) = advance(VELOCITY);
        let (cheap, _) = advance(0.0);
        samples.push((dear - cheap) / edges);
    }
    Ok(())
}
