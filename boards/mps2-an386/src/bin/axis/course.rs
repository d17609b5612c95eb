//! What a run is made of.

use board_mps2_an386::simulated::{INTERLOCK, Job, Plant};
use leadscrew::axis::Axis;
use leadscrew::estimator::EstimatorConfig;
use leadscrew_app::axis_control::AxisControl;
use leadscrew_app::options::Options;
use leadscrew_app::queues::{LinkEnds, Queues};
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{
    Desk, Fate, MoveAndBack, Operator, Scenario, ScenarioError, Script, Setup, World,
};
use static_cell::ConstStaticCell;

/// Seed of the encoder's errors and of all noise of the standard move.
const SEED: u64 = 1;

/// Who asks what of the axis.
pub enum Panel {
    /// The moves of a script.
    Script(Script),
    /// The timeline of a scenario.
    Desk(Desk<'static>),
}

/// A run: what it is made of, and who operates it.
pub struct Course {
    pub job: Job,
    /// To the tick, and what came of it.
    pub ends: LinkEnds,
    pub panel: Panel,
    pub tick_hz: f64,
    pub ticks: u32,
}

impl Course {
    /// The standard move on the reference machine, with the estimator asked for in the loop.
    pub fn standard_move(options: &Options) -> Result<Self, ScenarioError> {
        let tick_hz = f64::from(options.tick_hz);
        let scenario = MoveAndBack::standard(tick_hz);
        let estimator = EstimatorConfig::by_name(options.estimator)?.expect("it is in the list");
        let setup = Setup::new(&scenario, &MachineParams::z_16k20f3(), estimator, SEED)?;
        let (control, ends) = in_tick(setup.axis);
        Ok(Self {
            job: Job {
                plant: Plant::Machine(setup.machine),
                control,
                fate: Fate::new(&[], tick_hz),
            },
            ends,
            ticks: setup.script.ticks,
            panel: Panel::Script(setup.script),
            tick_hz,
        })
    }

    /// A scenario that is built in.
    pub fn scenario(scenario: &'static Scenario<'static>) -> Result<Self, ScenarioError> {
        let Scenario {
            tick_hz, timeline, ..
        } = *scenario;
        let plant = scenario.plant();
        let params = scenario.axis_params(&plant.machine)?;
        let config = params.validate()?;
        let operator = Operator::new(&params, &config)?;
        let (control, ends) = in_tick(Axis::new(config));
        Ok(Self {
            job: Job {
                plant: Plant::World(World::new(&plant, scenario)?),
                control,
                fate: Fate::new(timeline, tick_hz),
            },
            ends,
            panel: Panel::Desk(Desk::new(operator, timeline, tick_hz)),
            tick_hz,
            ticks: scenario.ticks()?,
        })
    }
}

/// The axis as what the tick computes.
fn in_tick(axis: Axis<'static>) -> (AxisControl<Plant>, LinkEnds) {
    static QUEUES: ConstStaticCell<Queues> = ConstStaticCell::new(Queues::new());
    // Nobody asks for captures here.
    let (tick, sender, ends, _) = QUEUES.take().split();
    (AxisControl::new(axis, tick, sender, &INTERLOCK), ends)
}
