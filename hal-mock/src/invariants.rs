//! What holds in every tick of every run, whatever happens to the axis.

use core::fmt;

use leadscrew::axis::{Axis, Outputs};
use leadscrew::supervisor::{FirstFault, State, Trip};
use leadscrew::units::Command;

/// What does not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Violation {
    /// The tick.
    pub tick: u32,
    /// What should have held.
    pub rule: &'static str,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "tick {}: {}", self.tick, self.rule)
    }
}

impl core::error::Error for Violation {}

/// Watches an axis tick by tick.
#[derive(Clone, Copy, Debug)]
pub struct Invariants {
    /// Bits of the largest command allowed.
    limit: i32,
    /// The first fault that is latched: its tick and what was found.
    first: Option<(u32, Trip)>,
    cleared: bool,
}

impl Invariants {
    /// For an axis whose output limit is `limit`, of full command.
    #[must_use]
    pub fn new(limit: f64) -> Self {
        Self {
            limit: Command::saturating_from_num(limit).to_bits(),
            first: None,
            cleared: false,
        }
    }

    /// A fault was cleared since the last tick: a new one may come.
    pub const fn note_cleared(&mut self) {
        self.cleared = true;
    }

    /// Checks the tick that `axis` has just stepped through.
    ///
    /// # Errors
    /// The first rule that does not hold.
    pub fn check(&mut self, axis: &Axis<'_>) -> Result<(), Violation> {
        let outputs = axis.outputs();
        let rule = |holds: bool, rule| match holds {
            true => Ok(()),
            false => Err(Violation {
                tick: outputs.tick,
                rule,
            }),
        };
        let size = outputs.command.to_bits().unsigned_abs();
        rule(
            size <= self.limit.unsigned_abs(),
            "the command is within the limit of the output",
        )?;
        check_state(outputs, rule)?;
        let first = axis.supervisor().first_fault();
        rule(
            first.map(|first| first.trip.fault) == outputs.fault,
            "the fault that is told is the one that is latched",
        )?;
        rule(
            self.cleared || self.first.is_none() || self.first == first.map(key),
            "the first fault is kept until it is cleared",
        )?;
        self.first = first.map(key);
        self.cleared = false;
        Ok(())
    }
}

fn key(first: &FirstFault) -> (u32, Trip) {
    (first.tick, first.trip)
}

/// What the state alone decides.
fn check_state(
    outputs: &Outputs,
    rule: impl Fn(bool, &'static str) -> Result<(), Violation>,
) -> Result<(), Violation> {
    let Outputs { state, enabled, .. } = *outputs;
    let is_zero = outputs.command == Command::ZERO;
    rule(
        enabled || is_zero,
        "the command is zero while the drive is off",
    )?;
    rule(
        enabled || !outputs.brake_released,
        "the brake is on while the drive is off",
    )?;
    rule(
        enabled || !outputs.moving,
        "nothing moves while the drive is off",
    )?;
    rule(
        !matches!(state, State::Disabled | State::Fault) || is_zero,
        "the command is zero in Disabled and in Fault",
    )?;
    rule(
        state != State::Disabled || !enabled,
        "the drive is off in Disabled",
    )?;
    rule(
        !matches!(state, State::Ready | State::Moving) || (enabled && outputs.brake_released),
        "under control the drive is on and the brake open",
    )?;
    rule(
        state != State::Fault || outputs.fault.is_some(),
        "there is no Fault without a fault",
    )?;
    let is_at_fault = matches!(state, State::Stopping | State::Fault);
    rule(
        outputs.fault.is_none() || is_at_fault,
        "with a fault the axis stops or stands in Fault",
    )
}
