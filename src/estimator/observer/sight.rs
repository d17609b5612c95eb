//! What a tick's edges, or their absence, do to the state.

use super::classes::{MAX_UNSEEN, ONE_A_TICK};
use super::motion::{COARSE_FRAC, INNOVATION_FRAC};
use super::{Estimator, Model};
use crate::capture::Observation;
use crate::edges::EdgeSample;
use crate::units::Position;

/// How far beyond its discrete a position may lie unpunished, d: what the places of the edges differ by.
const TOLERANCE: i64 = ONE / 4;
/// Octave of the gains at the end of a discrete: those of an edge in four ticks end a motion within some ten
/// ticks, and do not take a place that is a little off for a motion.
const HOLD_OCTAVE: i32 = ONE_A_TICK - 2;
/// One d as an innovation.
const ONE: i64 = 1 << INNOVATION_FRAC;
impl Estimator {
    /// Corrects by a sample of the edges.
    #[inline]
    pub(super) fn see(&mut self, observation: &Observation<'_>, sample: &EdgeSample) {
        let octave = density(sample.edges, self.unseen);
        // Beyond the last class velocity is not followed, only bounded by silence.
        self.anchored &= self.unseen < MAX_UNSEEN;
        self.octave = octave;
        self.silence = 0;
        self.unseen = 0;
        let drive = self.supervisor.model() == Model::Drive;
        let class = self.config.class(drive, octave);
        let place = relative(observation, sample);
        let predicted = self
            .motion
            .position_ago(sample.age.to_bits(), class.age_spread);
        let innovation = place.wrapping_sub(predicted);
        self.placed = place.wrapping_sub(nominal(observation, sample));
        if !self.anchored {
            self.anchored = true;
            let correction = innovation.wrapping_shl(COARSE_FRAC - INNOVATION_FRAC);
            self.motion.position = self.motion.position.wrapping_add(correction);
            return;
        }
        let Some(innovation) = credible(innovation) else {
            self.restart(observation);
            return;
        };
        self.motion
            .correct(innovation, &class.gains, &self.config.gain_scale);
        if drive {
            self.supervisor
                .weigh(innovation, class.per_sigma, &self.config.supervision);
        }
    }

    /// Without a sample the shaft is within the discrete all the same; a position that left it is brought
    /// back to its nearer end.
    #[inline]
    pub(super) fn hold(&mut self, observation: &Observation<'_>) {
        self.silence = if observation.delta == 0 {
            self.silence.saturating_add(1)
        } else {
            0
        };
        self.unseen = self.unseen.saturating_add(1);
        let position = self
            .motion
            .position
            .wrapping_shr(COARSE_FRAC - INNOVATION_FRAC)
            .wrapping_sub(self.placed);
        let outside = if position < TOLERANCE.wrapping_neg() {
            TOLERANCE.wrapping_neg().wrapping_sub(position)
        } else if position > ONE + TOLERANCE {
            (ONE + TOLERANCE).wrapping_sub(position)
        } else {
            return;
        };
        let Some(outside) = credible(outside) else {
            self.restart(observation);
            return;
        };
        let drive = self.supervisor.model() == Model::Drive;
        let gains = &self.config.class(drive, HOLD_OCTAVE).gains;
        self.motion.correct(outside, gains, &self.config.gain_scale);
        // What is taken for having stopped the shaft must not drive it back.
        let inward = (self.motion.acceleration ^ i64::from(outside)) >= 0;
        if !drive && inward {
            self.motion.acceleration = 0;
        }
    }
}

/// Octave of the density of edges: of `edges` now, after `unseen` ticks without. Where it lies between two it is the
/// lower one: gains for a longer time than that which passed are stable, those for a shorter one need not be.
#[inline]
const fn density(edges: u32, unseen: u32) -> i32 {
    let dense = (edges | 1).ilog2().cast_signed();
    let sparse = u32::BITS.wrapping_sub(unseen.leading_zeros()).cast_signed();
    dense.wrapping_sub(sparse).wrapping_add(ONE_A_TICK)
}

/// Place of a sample relative to the count, d with [`INNOVATION_FRAC`] bits.
#[inline]
const fn relative(observation: &Observation<'_>, sample: &EdgeSample) -> i64 {
    // No further than the motion of a tick and the map's correction: the low words suffice.
    let count = (observation.count as i32).wrapping_shl(Position::FRAC_NBITS);
    let place = sample.position.to_bits() as i32;
    (place.wrapping_sub(count) as i64).wrapping_shl(INNOVATION_FRAC - Position::FRAC_NBITS)
}

/// Where the sample would lie if every edge lay at its whole number.
#[inline]
const fn nominal(observation: &Observation<'_>, sample: &EdgeSample) -> i64 {
    let delta = observation.delta as i64;
    if sample.edges == 1 {
        if delta < 0 { ONE } else { 0 }
    } else {
        ONE.wrapping_sub(delta.wrapping_shl(INNOVATION_FRAC))
            .wrapping_shr(1)
    }
}

/// An innovation within ±8 d, which is that of a motion and not of a jump of the count.
#[inline]
const fn credible(innovation: i64) -> Option<i32> {
    let low = innovation as i32;
    if low as i64 == innovation {
        Some(low)
    } else {
        None
    }
}
