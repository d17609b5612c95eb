//! The law on the simulated machine, fed as LinuxCNC would feed it.
//!
//! Its motion controller gives in each tick the place for the next one, which is why the law compares the feedback
//! with the command of the tick before: so fed, the error is setpoint less position, as ours is. The feedback is the
//! count, in the middle of its discrete; its derivative is hostmot2's two edges, timed by our finer clock. The scale of
//! the output is that of the machine that the law is tuned on.

use leadscrew::capture::Unwrapper;
use leadscrew::hal::Encoder;
use leadscrew::units::{AxisScale, Command};
use leadscrew_hal_mock::machine::{Machine, MachineParams};

use super::{PidInputs, PidParams};
use crate::accuracy::TwoEdge;
use crate::tracking::error::TrackingError;
use crate::tracking::scene::TICK_HZ;
use crate::tracking::trace::{Tick, Trace};

/// Time of a tick, s.
pub const PERIOD_S: f64 = 1.0 / TICK_HZ;

/// A machine under LinuxCNC's hardware.
pub struct Bench {
    machine: Machine,
    unwrapper: Unwrapper,
    two_edge: TwoEdge,
    full_d_per_s: f64,
    command: Command,
}

impl Bench {
    /// The machine `actual` with the encoder that `seed` draws; a command is scaled for the drive of `nominal`.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(
        nominal: &MachineParams,
        actual: &MachineParams,
        seed: u64,
    ) -> Result<Self, TrackingError> {
        let scale = AxisScale::new(nominal.mount.counts_per_mm, TICK_HZ)?;
        let full_velocity = scale.velocity_from_feed(nominal.drive.full_command_feed_mm_per_min)?;
        Ok(Self {
            machine: Machine::new(actual, TICK_HZ, seed)?,
            unwrapper: Unwrapper::new(),
            two_edge: TwoEdge::new(actual.encoder.encoder.timer_hz / TICK_HZ),
            full_d_per_s: full_velocity * TICK_HZ,
            command: Command::ZERO,
        })
    }

    /// The output at full command, d/s.
    #[must_use]
    pub const fn full_d_per_s(&self) -> f64 {
        self.full_d_per_s
    }

    /// One tick of the machine: its feedback and the derivative of that, the command left to be filled in.
    pub fn sense(&mut self) -> PidInputs {
        self.machine.step(self.command, true);
        let capture = self.machine.capture();
        let observation = self.unwrapper.unwrap(&capture);
        let velocity = self.two_edge.update(&observation).velocity;
        PidInputs {
            command: 0.0,
            feedback: observation.count as f64 + 0.5,
            feedback_deriv: velocity * TICK_HZ,
        }
    }

    /// Puts out a velocity, d/s.
    pub fn put_out(&mut self, output: f64) {
        let share = (output / self.full_d_per_s).clamp(-1.0, 1.0);
        self.command = Command::from_num(share);
    }

    /// The tick that has just been sensed, with the setpoint that was for it.
    fn tick(&self, setpoint: f64, feedback: f64) -> Tick {
        let truth = self.machine.truth();
        Tick {
            setpoint,
            shaft: truth.shaft.position,
            seen: feedback,
            carriage: truth.carriage.position,
            command: self.command.to_num(),
        }
    }

    /// Follows `setpoints`, one a tick, by the law of `params`; the first is where the axis stands.
    #[must_use]
    pub fn follow(mut self, params: &PidParams, setpoints: &[f64]) -> Trace {
        let limits = PidParams {
            max_output: self.full_d_per_s,
            ..*params
        };
        let mut pid = super::Pid::new(limits, PERIOD_S);
        let mut start = None;
        let mut trace = Trace::with_capacity(setpoints.len());
        let first = setpoints.first().copied().unwrap_or_default();
        for (at, setpoint) in setpoints.iter().enumerate() {
            let sensed = self.sense();
            let stood = *start.get_or_insert(sensed.feedback);
            let next = setpoints.get(at + 1).unwrap_or(setpoint);
            let output = pid.step(&PidInputs {
                command: stood + (next - first),
                ..sensed
            });
            self.put_out(output);
            trace.push(self.tick(stood + (setpoint - first), sensed.feedback));
        }
        trace
    }
}
