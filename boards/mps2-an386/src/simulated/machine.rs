//! The machine in the guest, and what its interrupt does.

use leadscrew::axis::Inputs;
use leadscrew::hal::Encoder;
use leadscrew::telemetry::Record;
use leadscrew_app::axis_control::Inlet;
use leadscrew_hal_mock::machine::Machine;
use leadscrew_hal_mock::scenario::{Fate, World};
use leadscrew_hal_mock::trace::TraceDigest;

use crate::handoff::{Giver, Taker};

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
