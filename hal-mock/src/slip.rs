//! A coupling that slips: from some time on the encoder turns only a share of what the shaft turns.

use crate::arc::{Arc, State};

/// The slip.
#[derive(Clone, Copy, Debug)]
pub struct Slip {
    /// Share of the motion that is left.
    kept: f64,
    /// Ticks until it begins.
    ticks_left: u32,
    /// Where the encoder is since then.
    position: Option<f64>,
}

impl Slip {
    /// A loss of the share `lost` from a tick on; `None` where nothing is lost.
    pub fn new(lost: f64, from_tick: f64) -> Option<Self> {
        (lost > 0.0).then_some(Self {
            kept: 1.0 - lost,
            ticks_left: from_tick as u32,
            position: None,
        })
    }

    /// Loses the share `lost` from now on; what was lost before stays lost.
    pub fn set(&mut self, lost: f64) {
        self.kept = 1.0 - lost;
        self.ticks_left = 0;
    }

    /// What the encoder does where the shaft does `arc`.
    pub fn follow(&mut self, arc: &Arc) -> Arc {
        if self.ticks_left > 0 {
            self.ticks_left -= 1;
            return *arc;
        }
        let State {
            position,
            velocity,
            acceleration,
        } = arc.start;
        let slipped = Arc {
            start: State {
                position: self.position.unwrap_or(position),
                velocity: velocity * self.kept,
                acceleration: acceleration * self.kept,
            },
            jerk: arc.jerk * self.kept,
        };
        self.position = Some(slipped.end().position);
        slipped
    }
}
