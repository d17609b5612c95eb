//! The brake that holds a vertical axis, and the load on it.

use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::{AxisScale, RangeError};

use crate::drive::Grip;

leadscrew::parameter_table! {
    /// The brake and what it holds. The default is an axis that needs none.
    pub struct BrakeParams {
        /// 1: there is a brake; 0: there is none
        fitted: 0.0, "0 or 1", 0.0..=1.0;
        /// From the signal to the grip
        closes_after_s: 0.05, "s", 0.0..=10.0;
        /// From the signal to the release
        opens_after_s: 0.05, "s", 0.0..=10.0;
        /// Deceleration of a moving shaft by the brake
        deceleration_m_s2: 10.0, "m/s²", 0.001..=1e4;
        /// Acceleration of the shaft by its load where neither drive nor brake holds it
        load_m_s2: 0.0, "m/s²", -100.0..=100.0;
    }
}

/// The brake.
#[derive(Clone, Copy, Debug)]
pub struct Brake {
    fitted: bool,
    closes_after: u32,
    opens_after: u32,
    deceleration: f64,
    load: f64,
    released: bool,
    /// Ticks since the signal changed.
    since: u32,
}

impl Brake {
    /// A brake that grips.
    pub fn new(params: &BrakeParams, scale: AxisScale) -> Result<Self, RangeError> {
        params.check()?;
        let ticks = |time_s: f64| (time_s * scale.tick_hz() + 0.5) as u32;
        Ok(Self {
            fitted: params.fitted >= 0.5,
            closes_after: ticks(params.closes_after_s),
            opens_after: ticks(params.opens_after_s),
            deceleration: scale.acceleration_from_m_s2(params.deceleration_m_s2),
            load: scale.acceleration_from_m_s2(params.load_m_s2),
            released: false,
            since: u32::MAX,
        })
    }

    /// One tick with the signal to release at that level; the drive is enabled or not.
    pub fn step(&mut self, release: bool, enabled: bool) -> Grip {
        if release == self.released {
            self.since = self.since.saturating_add(1);
        } else {
            self.released = release;
            self.since = 0;
        }
        if self.is_gripping() {
            Grip::Braked(self.deceleration)
        } else if !enabled && self.load != 0.0 {
            Grip::Falling(self.load)
        } else {
            Grip::None
        }
    }

    /// True while it grips.
    pub const fn is_gripping(&self) -> bool {
        self.fitted
            && if self.released {
                self.since < self.opens_after
            } else {
                self.since >= self.closes_after
            }
    }
}
