//! The simulated machine at the part's pins: edges at their times, the converter that leads the drive, switches, probe,
//! drive lines, second encoder, steps.
//!
//! The machine goes in steps of 1/[`STEP_HZ`]; in each the drive has the command that the converter puts out at the
//! step's beginning, if its enable relay is on. The edges of the step are then known, and come at their times.

mod pins;
mod probe;
mod put_out;
mod steps;
mod wired;

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

use leadscrew::hal::Encoder as _;
use leadscrew::units::RangeError;
use leadscrew_hal_mock::scenario::{Base, Scenario, World, workshop};

use crate::CLOCK_HZ;
use crate::converter::Ad5761r;
use crate::emulator::Pin;
use crate::quadrature_lines::{AXIS, Lines, MASTER};
use probe::Probe;
use put_out::BoardOutputs;
pub use put_out::PutOut;
use steps::Steps;

/// Steps of the machine a second.
pub const STEP_HZ: f64 = 20_000.0;
/// Clocks of a step.
const STEP: u64 = CLOCK_HZ / STEP_HZ as u64;
/// The machine, as tests hold on to it while the emulator runs.
pub type MachineHandle = Arc<Mutex<AxisMachine>>;

/// A motion that replaces the drive's, for tests of the capture.
#[derive(Clone, Copy, Debug)]
struct Forced {
    clocks_per_edge: f64,
    direction: i8,
    next: f64,
}

/// The machine at the pins.
pub struct AxisMachine {
    world: World,
    lines: Lines,
    master: Option<Lines>,
    outputs: BoardOutputs,
    /// When the machine steps next.
    next_step: u64,
    pending: VecDeque<(u64, Pin, bool)>,
    /// Levels of the pins that only change from step to step.
    levels: [Option<bool>; Pin::COUNT],
    forced: Option<Forced>,
    steps: Option<Steps>,
    probe: Probe,
    analog: u16,
    edges: u64,
}

impl AxisMachine {
    /// The machine of the workshop, at rest.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn workshop(base: Base, seed: u64) -> Result<MachineHandle, RangeError> {
        Self::of(&workshop(base, STEP_HZ, seed))
    }

    /// The machine of a scenario, whose rate has to be 20 kHz.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn of(scenario: &Scenario<'_>) -> Result<MachineHandle, RangeError> {
        let scenario = Scenario {
            tick_hz: STEP_HZ,
            ..*scenario
        };
        let plant = scenario.plant();
        let world = World::new(&plant, &scenario)?;
        let encoder = &plant.machine.encoder.encoder;
        let count = world.board.machine.capture().count.cast_signed();
        let edges = world.board.machine.encoder().edges() as i32;
        let lines = Lines::new(AXIS, count, edges, encoder.index_width_d as i32);
        let master = world.spindle.as_ref().map(|spindle| {
            let count = spindle.capture().count.cast_signed();
            let edges = spindle.encoder().edges() as i32;
            Lines::new(MASTER, count, edges, encoder.index_width_d as i32)
        });
        let mut machine = Self {
            world,
            lines,
            master,
            outputs: BoardOutputs::default(),
            next_step: 0,
            pending: VecDeque::new(),
            levels: [None; Pin::COUNT],
            forced: None,
            steps: None,
            probe: Probe::default(),
            analog: 0x800,
            edges: 0,
        };
        machine.announce();
        Ok(Arc::new(Mutex::new(machine)))
    }

    /// The machine itself.
    #[must_use]
    pub const fn world(&self) -> &World {
        &self.world
    }

    /// The same, for troubles.
    pub const fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The output converter.
    #[must_use]
    pub const fn converter(&self) -> &Ad5761r {
        &self.outputs.converter
    }

    /// What the drive is told, as a share of full command.
    #[must_use]
    pub fn command(&self) -> f64 {
        self.outputs.command()
    }

    /// Levels of the relays of enable and brake.
    #[must_use]
    pub const fn relays(&self) -> (bool, bool) {
        self.outputs.relays
    }

    /// The clocks at which the relays of enable and brake went to the levels that they have.
    #[must_use]
    pub const fn relays_changed_at(&self) -> [u64; 2] {
        self.outputs.relays_changed_at
    }

    /// True while nothing can move: drive not enabled, converter at zero, brake not released.
    #[must_use]
    pub fn is_safe(&self) -> bool {
        self.outputs.is_safe()
    }

    /// The clock at which the converter was given its last value.
    #[must_use]
    pub const fn converted_at(&self) -> u64 {
        self.outputs.converted_at
    }

    /// What was put out since this was asked last.
    pub fn take_put_out(&mut self) -> PutOut {
        self.outputs.take_seen()
    }

    /// The x4 count of the encoder's lines.
    #[must_use]
    pub const fn count(&self) -> i32 {
        self.lines.count()
    }

    /// Edges of A and B so far.
    #[must_use]
    pub const fn edges(&self) -> u64 {
        self.edges
    }

    /// Lets the encoder turn at a rate of its own whatever the drive does, edges a second; negative is backward. Zero
    /// gives it back to the machine.
    pub fn force(&mut self, edges_per_s: f64) {
        let clocks_per_edge = CLOCK_HZ as f64 / edges_per_s.abs();
        self.forced = (edges_per_s != 0.0).then_some(Forced {
            clocks_per_edge,
            direction: if edges_per_s < 0.0 { -1 } else { 1 },
            next: self.next_step as f64 + clocks_per_edge,
        });
    }

    /// Lets the probe touch where the count comes to `count` or leaves it upward; `None` takes it away.
    pub fn put_probe(&mut self, count: Option<i32>) {
        self.probe.at = count;
    }

    /// The clock at which the probe touched last.
    #[must_use]
    pub const fn touched_at(&self) -> Option<u64> {
        self.probe.touched_at
    }

    /// Steps a second of the outer control; negative is backward.
    pub fn step_at(&mut self, steps_per_s: f64) {
        let count = self.steps.map_or(0, |steps| steps.count);
        let now = self.next_step;
        self.steps = Some(Steps::new(steps_per_s, now, count));
        self.pending
            .push_back((now, wired::DIRECTION, steps_per_s >= 0.0));
    }

    /// Steps that were given so far, those backward less.
    #[must_use]
    pub fn steps(&self) -> i64 {
        self.steps.map_or(0, |steps| steps.count)
    }

    /// The analog command, as a share of full scale.
    pub fn set_analog(&mut self, level: f64) {
        self.analog = (2048.0 + level * 2047.0).round().clamp(0.0, 4095.0) as u16;
    }

    fn announce(&mut self) {
        let mut changes = Vec::new();
        self.lines.announce(0, &mut changes);
        if let Some(master) = &self.master {
            master.announce(0, &mut changes);
        }
        self.tell_levels(0, &mut changes);
        self.pending.extend(changes);
    }

    /// One step: what changes in it, in the order of time.
    fn step(&mut self) {
        let from = self.next_step;
        self.next_step += STEP;
        self.world.step(&self.outputs.to_drive());
        let mut changes = Vec::new();
        self.turn(from, &mut changes);
        self.turn_master(from, &mut changes);
        if let Some(steps) = &mut self.steps {
            steps.give(self.next_step, &mut changes);
        }
        self.tell_levels(from + STEP / 2, &mut changes);
        self.pending.extend(changes);
        // Stable: what comes at the same clock stays in order. A pulse may reach into the next step.
        self.pending
            .make_contiguous()
            .sort_by_key(|&(clock, ..)| clock);
    }

    fn turn(&mut self, from: u64, changes: &mut Vec<(u64, Pin, bool)>) {
        if let Some(forced) = &mut self.forced {
            while forced.next < (from + STEP) as f64 {
                let clock = forced.next as u64;
                self.lines.pass(forced.direction, clock, changes);
                self.edges += 1;
                forced.next += forced.clocks_per_edge;
                self.probe.follow(self.lines.count(), clock, changes);
            }
            return;
        }
        for (time, direction) in self.world.board.machine.encoder().passed() {
            let clock = within_step(from, time);
            self.lines.pass(direction, clock, changes);
            self.edges += 1;
            self.probe.follow(self.lines.count(), clock, changes);
        }
    }

    fn turn_master(&mut self, from: u64, changes: &mut Vec<(u64, Pin, bool)>) {
        let (Some(lines), Some(spindle)) = (&mut self.master, &self.world.spindle) else {
            return;
        };
        for (time, direction) in spindle.encoder().passed() {
            lines.pass(direction, within_step(from, time), changes);
        }
    }
}

/// The clock of a stamp of the step that began at `from`; noise may have put it before.
fn within_step(from: u64, time: u32) -> u64 {
    let since = time.wrapping_sub(from as u32).cast_signed();
    from + since.clamp(0, STEP as i32 - 1).cast_unsigned() as u64
}
