//! Gains of the steady state, solved for once and held by the tick.

use super::Model;
use super::classes::{CLASSES, Class, GainScale, ONE_A_TICK, classes, design};
use super::config::Config;

/// Gains of both models by the density of edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Gains {
    pub(super) scale: GainScale,
    drive_classes: [Class; CLASSES],
    kinematic_classes: [Class; CLASSES],
}

impl Gains {
    /// Those of no observer.
    pub const NONE: Self = Self {
        scale: GainScale([0; 4]),
        drive_classes: [Class::ZERO; CLASSES],
        kinematic_classes: [Class::ZERO; CLASSES],
    };

    /// Solves 36 Riccati equations by iteration, each from the solution of its neighbour. Outside the tick.
    #[must_use]
    #[inline(never)]
    pub fn solve(config: &Config) -> Self {
        let per_tick = &config.per_tick;
        let drive = design(per_tick, &per_tick.drive());
        let kinematic = design(per_tick, &per_tick.kinematic());
        let scale = GainScale::holding(&drive, &kinematic);
        Self {
            drive_classes: classes(&drive, &scale, false),
            kinematic_classes: classes(&kinematic, &scale, true),
            scale,
        }
    }

    /// Corrections of x, v, a and δ (d and ticks) for an innovation of 1 d at 2^`octave` edges a tick, as
    /// quantised.
    #[must_use]
    pub fn of(&self, model: Model, octave: i32) -> [f64; 4] {
        let index = (ONE_A_TICK as i32).saturating_sub(octave).max(0);
        let class = self.class(model == Model::Drive, index.unsigned_abs() as usize);
        let mut gains = [0.0; 4];
        for ((gain, bits), frac) in gains.iter_mut().zip(class.gains).zip(self.scale.fracs()) {
            *gain = libm::ldexp(f64::from(bits), frac.cast_signed().wrapping_neg());
        }
        gains
    }

    /// Gains by density of edges, 2^(10 − `index`) in a tick.
    #[inline]
    pub(super) fn class(&self, drive: bool, index: usize) -> &Class {
        let classes = if drive {
            &self.drive_classes
        } else {
            &self.kinematic_classes
        };
        let [.., rarest] = classes;
        classes.get(index).unwrap_or(rarest)
    }
}

/// A configuration, and the gains that follow from it: beside each other, so that the tick has one address for both.
#[derive(Clone, Debug)]
#[repr(C)]
pub(super) struct Solved {
    pub config: Config,
    pub gains: Gains,
}

/// Ticks in which the kinematic filter settles at one edge a tick.
pub(super) fn warm_up_ticks(config: &Config) -> u32 {
    let kinematic = config.per_tick.kinematic();
    let design = design(&config.per_tick, &kinematic);
    design
        .get(ONE_A_TICK)
        .map_or(0, |steady| kinematic.settling_ticks(&steady.gains))
}
