//! What the settings of an axis say of its drive.

use std::f64::consts::TAU;

use leadscrew_client::{Axis, Error};

use super::Point;

/// A drive of second order with a delay: ω²/(s² + 2ζω·s + ω²)·e^(−sτ), its gain 1 at standstill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveCurve {
    /// 2π/ω, s.
    pub natural_period_s: f64,
    /// ζ.
    pub damping: f64,
    /// τ, s.
    pub delay_s: f64,
    /// Gain at standstill.
    pub gain: f64,
}

impl DriveCurve {
    /// The drive that the observer of an axis is set to, relative to a feed at full command in mm/min.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn of(axis: &mut Axis, full_feed: f64) -> Result<Self, Error> {
        let mut number = |name: &str| {
            let value = axis.parameter(name)?.number();
            value.ok_or_else(|| Error::Unexpected {
                asked: name.to_owned(),
            })
        };
        Ok(Self {
            natural_period_s: number("observer.natural_period_s")?,
            damping: number("observer.damping")?,
            delay_s: number("observer.delay_s")?,
            gain: number("observer.full_command_feed_mm_per_min")? / full_feed,
        })
    }

    /// Its response.
    #[must_use]
    pub fn at(&self, hz: f64) -> Point {
        let share = hz * self.natural_period_s;
        let (re, im) = (1.0 - share * share, 2.0 * self.damping * share);
        let phase = -im.atan2(re) - TAU * hz * self.delay_s;
        Point {
            hz,
            gain: self.gain / re.hypot(im),
            phase_deg: phase.to_degrees(),
            coherence: 1.0,
        }
    }
}
