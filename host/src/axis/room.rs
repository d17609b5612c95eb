//! Where an axis may be moved to.

use leadscrew::settings::Settings;
use leadscrew_client::Status;

use super::ProcedureError;

/// Free travel, in the coordinate that the axis has now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Low end, mm.
    pub low_mm: f64,
    /// High end, mm.
    pub high_mm: f64,
}

impl Room {
    /// So much to either side of where the axis stands, as far as soft limits allow.
    #[must_use]
    pub fn around(status: &Status, settings: &Settings, minus_mm: f64, plus_mm: f64) -> Self {
        let at = status.position_mm;
        let asked = Self {
            low_mm: at - minus_mm,
            high_mm: at + plus_mm,
        };
        match Self::of_limits(status, settings) {
            None => asked,
            Some(limits) => Self {
                low_mm: asked.low_mm.max(limits.low_mm),
                high_mm: asked.high_mm.min(limits.high_mm),
            },
        }
    }

    /// The soft limits, of an axis that is homed and has some.
    #[must_use]
    pub fn of_limits(status: &Status, settings: &Settings) -> Option<Self> {
        let motion = &settings.axis.motion;
        let has_limits = motion.travel_low_mm < motion.travel_high_mm;
        (status.is_homed && has_limits).then_some(Self {
            low_mm: motion.travel_low_mm,
            high_mm: motion.travel_high_mm,
        })
    }

    /// Its length, mm.
    #[must_use]
    pub fn length_mm(&self) -> f64 {
        self.high_mm - self.low_mm
    }

    /// The place of that length that is nearest to where the axis stands: from, to.
    ///
    /// # Errors
    /// [`ProcedureError::NoRoom`]
    pub fn place(
        &self,
        at_mm: f64,
        needed_mm: f64,
        what: &'static str,
        advice: &'static str,
    ) -> Result<(f64, f64), ProcedureError> {
        if self.length_mm() < needed_mm {
            return Err(ProcedureError::NoRoom {
                what,
                needed_mm,
                free_mm: self.length_mm(),
                low_mm: self.low_mm,
                high_mm: self.high_mm,
                at_mm,
                advice,
            });
        }
        let from = at_mm.max(self.low_mm).min(self.high_mm - needed_mm);
        Ok((from, from + needed_mm))
    }
}
