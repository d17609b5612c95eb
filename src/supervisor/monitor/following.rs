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
    rest_ticks: u32,
}

impl Following {
    /// Judges the following error `error` (Q15.16 d) at a setpoint of `velocity` (Q11.20 d/tick).
    #[inline]
    pub fn check(&mut self, limits: &Limits, error: i32, velocity: i32, moving: bool) -> Verdict {
        let size = error.saturating_abs();
        if size > self.peak {
            self.peak = size;
        }
        self.rest_ticks = if moving || velocity != 0 {
            0
        } else {
            self.rest_ticks.saturating_add(1)
        };
        // No limit or level is below the smaller of these two.
        if size <= limits.warning_base() && size <= limits.standstill {
            return Verdict::Good;
        }
        self.judge(limits, error, velocity)
    }

    #[cold]
    #[inline(never)]
    fn judge(&self, limits: &Limits, error: i32, velocity: i32) -> Verdict {
        let size = error.saturating_abs();
        let limit = limits.at(velocity);
        if size > limit {
            return Verdict::Fault(Trip::of_bits(Fault::FollowingError, error, limit, 16));
        }
        if self.rest_ticks > limits.standstill_after && size > limits.standstill {
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
    pub const fn restart(&mut self) {
        self.rest_ticks = 0;
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

    #[inline]
    fn warning_base(&self) -> i32 {
        self.warned(self.base)
    }
}
