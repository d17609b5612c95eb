//! Following error: a limit that grows with velocity, a warning below it, the peak; and standstill.

use super::super::fault::Fault;
use super::super::record::Trip;
use crate::estimator::saturate;

/// Following errors allowed, Q15.16 d.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// At rest.
    pub base: i32,
    /// Growth with the setpoint's velocity, Q15.16 d for each d/tick.
    pub per_velocity: i32,
    /// Share of the limit from which on a warning is given, Q.15.
    pub warning_share: u32,
    /// While the setpoint rests.
    pub standstill: i32,
    /// Ticks of rest before that counts.
    pub standstill_after: u32,
    /// Errors up to which no limit or level can be passed in motion: made by [`Limits::with_quiet`].
    pub quiet: i32,
    /// The same at rest.
    pub quiet_at_rest: i32,
}

/// What the error came to in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// All is well.
    Good,
    /// Above the warning level.
    Warning,
    /// Above a limit.
    Fault(Trip),
}

/// The monitor.
#[derive(Clone, Copy, Debug, Default)]
pub struct Following {
    /// Largest error since the last reset, Q15.16 d.
    pub peak: i32,
    /// Last tick in which the setpoint moved. A rest of 2³² ticks begins anew.
    moved_at: u32,
}

impl Following {
    /// Takes notice of the following error `error` (Q15.16 d); true if it needs no judgement.
    #[inline(always)]
    pub fn is_quiet(&mut self, limits: &Limits, error: i32, is_at_rest: bool, tick: u32) -> bool {
        let size = error.saturating_abs();
        if size > self.peak {
            self.peak = size;
        }
        if !is_at_rest {
            self.moved_at = tick;
        }
        size <= if is_at_rest {
            limits.quiet_at_rest
        } else {
            limits.quiet
        }
    }

    /// Judges it, at a setpoint of `velocity` (Q11.20 d/tick).
    pub fn judge(&self, limits: &Limits, error: i32, velocity: i32, tick: u32) -> Verdict {
        let size = error.saturating_abs();
        let limit = limits.at(velocity);
        if size > limit {
            return Verdict::Fault(Trip::of_bits(Fault::FollowingError, error, limit, 16));
        }
        let rest_ticks = tick.wrapping_sub(self.moved_at);
        if rest_ticks > limits.standstill_after && size > limits.standstill {
            let limit = limits.standstill;
            return Verdict::Fault(Trip::of_bits(Fault::MotionAtStandstill, error, limit, 16));
        }
        if size > limits.warned(limit) {
            Verdict::Warning
        } else {
            Verdict::Good
        }
    }

    /// Begins anew, with the peak as it is.
    pub const fn restart(&mut self, tick: u32) {
        self.moved_at = tick;
    }
}

impl Limits {
    /// The limit at a setpoint's velocity, Q11.20 d/tick.
    fn at(&self, velocity: i32) -> i32 {
        let growth = i64::from(self.per_velocity)
            .wrapping_mul(i64::from(velocity.saturating_abs()))
            .wrapping_shr(20);
        saturate(growth.wrapping_add(i64::from(self.base)))
    }

    fn warned(&self, limit: i32) -> i32 {
        if limit == i32::MAX {
            return limit;
        }
        i64::from(limit)
            .wrapping_mul(i64::from(self.warning_share))
            .wrapping_shr(15) as i32
    }

    /// The same with the error up to which there is nothing to judge.
    #[must_use]
    pub fn with_quiet(self) -> Self {
        let quiet = self.warned(self.base);
        Self {
            quiet,
            quiet_at_rest: quiet.min(self.standstill),
            ..self
        }
    }
}
