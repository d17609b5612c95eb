//! The whole step with everything switched on, over the moving ticks of the standard move: what the budget of a
//! tick is about. Observer in the loop, polynomial for display, notch and low-pass, friction and dead time, backlash
//! and a full screw table, the feedforward ahead and learned, a push at rest, every monitor, and the record of telemetry.
//!
//! `one_stamp` is told the last edge's time alone, as by boards with one capture register; `all_edges` all of them.
//!
//! The worst ticks lie where a move starts or ends: the samples of the polynomial's window do not stand one a tick and its
//! normal equations are made anew, of as many samples as the window has (15 here, 64 at most), while the supervisor
//! looks at every monitor in full. Every fourth tick in motion pays for a step of what is learned as well.

use board_mps2_an386::instructions::Counter;
use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::compensation::table::POINTS;
use leadscrew::compensation::{CompensationParams, ScrewPoint, ScrewTable, Stretch};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::paths::{Choice, Paths};
use leadscrew::hal::{Capture, Encoder};
use leadscrew::params::{
    AxisConfig, AxisParams, ControllerParams, FilterParams, FrictionParams, ParamError,
};
use leadscrew::telemetry::Record;
use leadscrew::units::Position;
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::{MoveAndBack, ScenarioError, Script};
use static_cell::ConstStaticCell;

use crate::samples::Samples;

const TICK_HZ: f64 = 1000.0;
const SEED: u64 = 1;
/// From point to point of the table, d: a little more than the standard move in all.
const SPACING: i64 = 1250;
/// Where the table begins, d before the place of the start.
const BEFORE: i64 = 8 * SPACING;

static MEMORY: ConstStaticCell<[Stretch; POINTS.1]> =
    ConstStaticCell::new([Stretch::EMPTY; POINTS.1]);
static ONE_STAMP: ConstStaticCell<Samples> = ConstStaticCell::new(Samples::of("one_stamp"));
static ALL_EDGES: ConstStaticCell<Samples> = ConstStaticCell::new(Samples::of("all_edges"));

pub fn run(counter: &mut Counter) -> Result<(), ScenarioError> {
    let table = table(MEMORY.take());
    for (samples, takes_all) in [(ONE_STAMP.take(), false), (ALL_EDGES.take(), true)] {
        shuttle(counter, table, takes_all, samples)?;
        samples.log("whole");
    }
    Ok(())
}

/// The standard move there and back.
fn shuttle(
    counter: &mut Counter,
    table: ScrewTable<'_>,
    takes_all: bool,
    samples: &mut Samples,
) -> Result<(), ScenarioError> {
    let scenario = MoveAndBack::standard(TICK_HZ);
    let machine = MachineParams::z_16k20f3();
    let (config, counts_per_mm) = config(&scenario, &machine)?;
    let script = Script::new(&scenario, counts_per_mm, &config)?;
    let mut axis = Axis::new(config);
    axis.set_screw_table(Some(table))
        .expect("the table is flat enough");
    axis.set_origin(Some(Position::from_num(-BEFORE)));
    let mut machine = Machine::new(&machine, TICK_HZ, SEED)?;
    let mut applied = Outputs::default();
    let mut moves = script.moves.iter().peekable();
    for tick in 0..script.ticks {
        if let Some(next) = moves.next_if(|next| next.start == tick) {
            axis.queue(&next.profile, next.start)
                .expect("the axis is ready");
        }
        machine.step(applied.command, applied.enabled);
        let mut capture = machine.capture();
        if !takes_all {
            capture = Capture {
                edges: [&[], &[]],
                ..capture
            };
        }
        let inputs = Inputs {
            readback: Some(applied.command),
            ..Inputs::of(capture, true)
        };
        let cost = counter.count(|| Record::new(axis.step(&inputs)));
        applied = *axis.outputs();
        assert!(applied.fault.is_none(), "the move is undisturbed");
        if applied.moving {
            samples.push(cost);
        }
    }
    Ok(())
}

/// Everything on; with the counts that a mm has.
fn config(
    scenario: &MoveAndBack,
    machine: &MachineParams,
) -> Result<(AxisConfig, f64), ScenarioError> {
    let by_name = |name| Ok::<_, ParamError>(EstimatorConfig::by_name(name)?.expect("it is one"));
    let observer = scenario.tuned(machine, by_name("observer")?, false)?;
    let tuned = scenario.axis_params(machine, observer)?;
    let params = AxisParams {
        controller: ControllerParams {
            feedforward_lead_s: machine.drive.delay_s + 0.5 / TICK_HZ,
            rest_band_mm: 0.001,
            learning_noise: 1e-3,
            ..tuned.controller
        },
        second_estimator: Some(by_name("polynomial")?),
        paths: Paths {
            display: Choice::Second,
            ..Paths::default()
        },
        filter: FilterParams {
            notch_hz: 180.0,
            notch_damping: 0.2,
            low_pass_hz: 250.0,
            ..FilterParams::default()
        },
        friction: FrictionParams {
            forward_mm_per_min: 20.0,
            backward_mm_per_min: 25.0,
            excess_forward_mm_per_min: 10.0,
            excess_backward_mm_per_min: 10.0,
            dead_time_s: 0.003,
            lift_s: 0.06,
            ..FrictionParams::default()
        },
        compensation: CompensationParams {
            backlash_mm: 0.003,
            screw_table: 1.0,
            ..CompensationParams::default()
        },
        ..tuned
    };
    Ok((params.validate()?, params.motion.counts_per_mm))
}

/// A screw with an error of a few d, other ones in either direction.
fn table(memory: &mut [Stretch]) -> ScrewTable<'_> {
    let mut points = [ScrewPoint::default(); POINTS.1];
    for (at, point) in (0_i64..).zip(&mut points) {
        point.position = Position::from_num(at * SPACING);
        point.error = [at % 3, at % 2].map(|error| Position::from_num(error).to_num());
    }
    ScrewTable::build(&points, memory).expect("the points are in order")
}
