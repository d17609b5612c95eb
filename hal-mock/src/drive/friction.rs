//! Friction of the shaft.

use leadscrew::units::{AxisScale, RangeError};

use super::DriveParams;

/// Stribeck friction, in terms of the velocity that the drive aims at.
#[derive(Clone, Debug)]
pub struct Friction {
    kinetic: f32,
    /// Excess of static over kinetic friction.
    excess: f32,
    /// What holds the shaft at rest.
    pub held: f32,
    per_stribeck: f32,
}

impl Friction {
    /// `None` without friction.
    pub fn new(params: &DriveParams, scale: AxisScale) -> Result<Option<Self>, RangeError> {
        let kinetic = scale.velocity_from_feed(params.friction_mm_per_min)?;
        let excess = kinetic * (params.stiction_ratio - 1.0);
        let stribeck = scale.velocity_from_feed(params.stribeck_mm_per_min)?;
        Ok((kinetic > 0.0).then(|| Self {
            kinetic: kinetic as f32,
            excess: excess as f32,
            held: (kinetic + excess) as f32,
            per_stribeck: (1.0 / stribeck) as f32,
        }))
    }

    /// Size of the friction at a speed.
    pub fn at(&self, speed: f32) -> f32 {
        let relative = speed * self.per_stribeck;
        self.kinetic + self.excess / (1.0 + relative * relative)
    }
}
