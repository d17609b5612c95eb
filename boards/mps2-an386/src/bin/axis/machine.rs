//! The machine in the guest: what its interrupt does, and what the run is made of.

use board_mps2_an386::handoff::{Giver, Taker};
use leadscrew::axis::{Axis, Inputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Encoder;
use leadscrew::telemetry::Record;
use leadscrew_app::axis_control::Inlet;
use leadscrew_app::options::Options;
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::{
    Desk, Fate, MoveAndBack, Operator, Scenario, ScenarioError, Script, Setup, World,
};
use leadscrew_hal_mock::trace::TraceDigest;

/// Seed of the encoder's errors and of all noise of the standard move.
const SEED: u64 = 1;

/// What the axis moves.
#[expect(
    clippy::large_enum_variant,
    reason = "there is one, in a static, and no heap"
)]
pub enum Plant {
    /// A machine at whose board all is well.
    Machine(Machine),
    /// A machine and its board, with troubles.
    World(World),
}

impl Inlet for Plant {
    fn inputs(&self, enable: bool) -> Inputs<'_> {
        match self {
            Self::Machine(machine) => Inputs::of(machine.capture(), enable),
            Self::World(world) => world.inputs(enable),
        }
    }
}

/// Who asks what of the axis.
pub enum Panel {
    /// The moves of a script.
    Script(Script),
    /// The timeline of a scenario.
    Desk(Desk<'static>),
}

/// What a run is made of.
pub struct Job {
    pub plant: Plant,
    pub axis: Axis<'static>,
    pub panel: Panel,
    /// What is done to the plant.
    pub fate: Fate<'static>,
    pub tick_hz: f64,
    pub ticks: u32,
}

impl Job {
    /// The standard move on the reference machine, with the estimator asked for in the loop.
    pub fn standard_move(options: &Options) -> Result<Self, ScenarioError> {
        let tick_hz = f64::from(options.tick_hz);
        let scenario = MoveAndBack::standard(tick_hz);
        let estimator = EstimatorConfig::by_name(options.estimator)?.expect("it is in the list");
        let setup = Setup::new(&scenario, &MachineParams::z_16k20f3(), estimator, SEED)?;
        Ok(Self {
            plant: Plant::Machine(setup.machine),
            axis: setup.axis,
            ticks: setup.script.ticks,
            panel: Panel::Script(setup.script),
            fate: Fate::new(&[], tick_hz),
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
        Ok(Self {
            plant: Plant::World(World::new(&plant, scenario)?),
            axis: Axis::new(config),
            panel: Panel::Desk(Desk::new(operator, timeline, tick_hz)),
            fate: Fate::new(timeline, tick_hz),
            tick_hz,
            ticks: scenario.ticks()?,
        })
    }
}

/// The machine interrupt's state.
pub struct MachineState {
    inputs: Giver<Plant>,
    records: Taker<Record>,
    fate: Fate<'static>,
    /// What the tick put out last; before the first tick nothing.
    applied: Record,
    digest: TraceDigest,
}

impl MachineState {
    /// The state before the first step; the plant is in the handoff to the tick.
    pub fn new(inputs: Giver<Plant>, records: Taker<Record>, fate: Fate<'static>) -> Self {
        Self {
            inputs,
            records,
            fate,
            applied: Record::default(),
            digest: TraceDigest::new(),
        }
    }

    /// Digest of the ticks so far.
    pub fn digest(&self) -> u64 {
        self.digest.value()
    }

    /// Moves the machine as the last tick wants it.
    pub fn step(&mut self) {
        self.account();
        let (command, enabled) = self.applied.drive();
        let (fate, applied) = (&mut self.fate, &self.applied);
        // Not taken: the tick did not run, and the next one finds these inputs again as one too few.
        let _ = self.inputs.give(|plant| match plant {
            Plant::Machine(machine) => machine.step(command, enabled),
            // A trouble that cannot be is one that is not there: the digest then tells.
            Plant::World(world) => drop(fate.step(world, applied)),
        });
    }

    /// Takes the last tick into the digest, while the machine still shows what that tick saw.
    pub fn account(&mut self) {
        let Some(record) = self.records.take(|record| *record) else {
            return;
        };
        self.applied = record;
        let (digest, fate) = (&mut self.digest, &self.fate);
        let _ = self.inputs.look(|plant| {
            let inputs = match plant {
                Plant::Machine(_) => plant.inputs(record.drive().1),
                Plant::World(world) => fate.inputs(world),
            };
            digest.update(&inputs, &record);
        });
    }
}
