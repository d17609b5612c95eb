//! The machine in the guest: what its interrupt does, and what the run is made of.

use board_mps2_an386::handoff::{Giver, Taker};
use leadscrew::axis::Inputs;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Encoder;
use leadscrew::telemetry::Record;
use leadscrew_app::options::Options;
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::{MoveAndBack, ScenarioError, Setup};
use leadscrew_hal_mock::trace::TraceDigest;

/// Seed of the encoder's errors and of all noise.
const SEED: u64 = 1;

/// The standard move on the reference machine, with the estimator asked for in the loop.
pub fn standard_move(options: &Options) -> Result<Setup<'static>, ScenarioError> {
    let scenario = MoveAndBack::standard(f64::from(options.tick_hz));
    let estimator = EstimatorConfig::by_name(options.estimator)?.expect("it is in the list");
    Setup::new(&scenario, &MachineParams::z_16k20f3(), estimator, SEED)
}

/// The machine interrupt's state.
pub struct MachineState {
    inputs: Giver<Machine>,
    records: Taker<Record>,
    /// What the tick put out last; before the first tick nothing.
    applied: Record,
    digest: TraceDigest,
}

impl MachineState {
    /// The state before the first step; the machine is in the handoff to the tick.
    pub fn new(inputs: Giver<Machine>, records: Taker<Record>) -> Self {
        Self {
            inputs,
            records,
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
        // Not taken: the tick did not run, and the next one finds these inputs again as one too few.
        let _ = self.inputs.give(|machine| machine.step(command, enabled));
    }

    /// Takes the last tick into the digest, while the machine still shows what that tick saw.
    pub fn account(&mut self) {
        let Some(record) = self.records.take(|record| *record) else {
            return;
        };
        self.applied = record;
        let digest = &mut self.digest;
        let _ = self.inputs.look(|machine| {
            let inputs = Inputs::of(machine.capture(), record.drive().1);
            digest.update(&inputs, &record);
        });
    }
}
