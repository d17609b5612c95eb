//! Tuning by LinuxCNC's own rule, written from pid(9) and the table of its tuning guide.
//!
//! At a standing command the output is ± the effort by the sign of the error. From the limit cycle's mean amplitude
//! and period come the ultimate gain, 4/π of the effort over the amplitude, and the ultimate period; from these the
//! gains by Ziegler and Nichols.

use std::f64::consts::FRAC_1_PI;

use super::PidParams;
use super::bench::{Bench, PERIOD_S};
use crate::tracking::error::TrackingError;

/// Half cycles that are averaged over (tune-cycles), as many as let any beginning be forgotten.
const HALF_CYCLES: u32 = 50;
/// Half cycles before, until the cycle is steady.
const BEFORE: u32 = 10;
/// Most ticks of an experiment.
const MAX_TICKS: u32 = 60_000;

/// What the experiment shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ultimate {
    /// Gain at which the loop would oscillate, 1/s.
    pub gain: f64,
    /// Period of that oscillation, s.
    pub period_s: f64,
}

impl Ultimate {
    /// Lets `bench` oscillate under a relay of `effort` d/s.
    ///
    /// # Errors
    /// No limit cycle.
    pub fn measure(mut bench: Bench, effort: f64) -> Result<Self, TrackingError> {
        let command = bench.sense().feedback;
        let mut output = effort;
        let (mut halves, mut largest, mut sum, mut ticks) = (0_u32, 0.0_f64, 0.0, 0_u32);
        for _ in 0..MAX_TICKS {
            bench.put_out(output);
            let error = command - bench.sense().feedback;
            if error * output < 0.0 {
                output = -output;
                if halves > BEFORE {
                    sum += largest;
                }
                largest = 0.0;
                halves += 1;
                if halves > BEFORE + HALF_CYCLES {
                    let amplitude = sum / f64::from(HALF_CYCLES);
                    return Ok(Self {
                        gain: 4.0 * FRAC_1_PI * effort / amplitude,
                        period_s: 2.0 * f64::from(ticks) * PERIOD_S / f64::from(HALF_CYCLES),
                    });
                }
            }
            largest = largest.max(error.abs());
            ticks += u32::from(halves > BEFORE);
        }
        Err(TrackingError::NoLimitCycle {
            effort_d_per_s: effort,
            ticks: MAX_TICKS,
        })
    }

    /// tune-type 0: P, I and D; all feedforwards are zero.
    #[must_use]
    pub fn with_derivative(&self) -> PidParams {
        let p = 0.6 * self.gain;
        PidParams {
            p,
            i: p / (0.5 * self.period_s),
            d: p * 0.125 * self.period_s,
            ..PidParams::default()
        }
    }

    /// tune-type 1: P, I and FF1, for an output in user units a second.
    #[must_use]
    pub fn with_feedforward(&self) -> PidParams {
        let p = 0.45 * self.gain;
        PidParams {
            p,
            i: p * 1.2 / self.period_s,
            ff1: 1.0,
            ..PidParams::default()
        }
    }
}
