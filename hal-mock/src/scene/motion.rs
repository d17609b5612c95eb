//! The motions there are.

use super::{SCurve, Swing};

/// A motion known beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Constant velocity, d/tick.
    Steady {
        /// Velocity, d/tick.
        velocity: f64,
    },
    /// Constant acceleration from a velocity on, without end.
    Ramp {
        /// Velocity at first, d/tick.
        velocity: f64,
        /// Acceleration, d/tick².
        acceleration: f64,
    },
    /// Constant jerk from rest.
    Jerk {
        /// Jerk, d/tick³.
        jerk: f64,
    },
    /// A flywheel that coasts to a stop.
    Coast {
        /// Velocity at first, d/tick.
        velocity: f64,
        /// Loss of velocity, d/tick²; of the same sign as the velocity.
        deceleration: f64,
    },
    /// From rest to a velocity and back to rest with bounded acceleration and jerk.
    SCurve(SCurve),
    /// To and fro.
    Sine(Swing),
    /// The feed of a real axis: a steady one that wobbles and drifts.
    Feed {
        /// Mean velocity, d/tick.
        velocity: f64,
        /// The short wave on it.
        wobble: Swing,
        /// The long wave on it.
        drift: Swing,
    },
}

impl Motion {
    /// P1's flywheel: from 20 d/tick at −0.006 d/tick².
    pub const FLYWHEEL: Self = Self::Coast {
        velocity: 20.0,
        deceleration: 0.006,
    };

    /// The reference S-curve: to 150 d/tick with 0.9 d/tick² and 0.01 d/tick³ at most, and back to rest
    /// after a cruise of `cruise_ticks`; once.
    #[must_use]
    pub const fn s_curve(cruise_ticks: u32) -> Self {
        Self::SCurve(SCurve {
            velocity: 150.0,
            acceleration: 0.9,
            jerk: 0.01,
            cruise_ticks,
            rest_ticks: 0,
            there_and_back: false,
        })
    }

    /// The reference motion with reversals: ±2 000 d in 400 ticks.
    pub const SINE: Self = Self::Sine(Swing {
        amplitude: 2000.0,
        period_ticks: 400.0,
        phase_turns: 0.0,
    });

    /// The feed in which an encoder of `edges_per_revolution` is calibrated: a wobble of 1.7 d in 90 ticks and
    /// a drift of 3 d in 7.3 revolutions, at phases of no account.
    #[must_use]
    pub fn calibration(velocity: f64, edges_per_revolution: f64) -> Self {
        let speed = velocity.max(-velocity);
        Self::Feed {
            velocity,
            wobble: Swing {
                amplitude: 1.7,
                period_ticks: 90.0,
                phase_turns: 0.0,
            },
            drift: Swing {
                amplitude: 3.0,
                period_ticks: DRIFT_REVOLUTIONS * edges_per_revolution / speed,
                phase_turns: 0.0,
            },
        }
    }

    /// The same motion in the other direction: its mirror image about the start.
    #[must_use]
    pub const fn reversed(self) -> Self {
        match self {
            Self::Steady { velocity } => Self::Steady {
                velocity: -velocity,
            },
            Self::Ramp {
                velocity,
                acceleration,
            } => Self::Ramp {
                velocity: -velocity,
                acceleration: -acceleration,
            },
            Self::Jerk { jerk } => Self::Jerk { jerk: -jerk },
            Self::Coast {
                velocity,
                deceleration,
            } => Self::Coast {
                velocity: -velocity,
                deceleration: -deceleration,
            },
            Self::SCurve(curve) => Self::SCurve(SCurve {
                velocity: -curve.velocity,
                ..curve
            }),
            Self::Sine(swing) => Self::Sine(swing.reversed()),
            Self::Feed {
                velocity,
                wobble,
                drift,
            } => Self::Feed {
                velocity: -velocity,
                wobble: wobble.reversed(),
                drift: drift.reversed(),
            },
        }
    }
}

/// No whole number, so that the drift is not the same in every run of revolutions.
const DRIFT_REVOLUTIONS: f64 = 7.3;
