//! What a tick's edges, or their absence, do to the state.

use super::classes::{Class, MAX_UNSEEN, ONE_A_TICK};
use super::gains::Solved;
use super::motion::{INNOVATION_FRAC, PLACE_FRAC, high};
use super::{Model, State};
use crate::capture::Observation;
use crate::edges::{EdgeSample, Span};
use crate::estimator::Estimate;
use crate::units::{Lag, Position, Velocity};

/// How far beyond its discrete a position may lie unpunished, d: what the places of the edges differ by.
const TOLERANCE: i64 = ONE / 4;
/// Class of the gains at the end of a discrete: those of an edge in four ticks end a motion within some ten
/// ticks, and do not take a place that is a little off for a motion.
const HOLD_CLASS: usize = ONE_A_TICK + 2;
/// By how much the motion of a tick may differ from a velocity that no edge has confirmed, Q11.20 d/tick.
const MOST_SLIP: u32 = 1000 << Velocity::FRAC_NBITS;
/// One d as a position.
const ONE: i64 = 1 << PLACE_FRAC;

impl State {
    /// Corrects by a sample of the edges; gives the class of their density.
    #[inline]
    pub(super) fn see<'c>(
        &mut self,
        solved: &'c Solved,
        observation: &Observation<'_>,
        sample: &EdgeSample,
    ) -> &'c Class {
        let unseen = self.unseen;
        self.class = density(sample.edges, unseen);
        self.silence = 0;
        self.unseen = 0;
        self.placed = sample.correction;
        let drive = self.supervisor.model() == Model::Drive;
        let class = solved.gains.class(drive, self.class);
        let place = relative(observation, sample);
        // Beyond the last class velocity is not followed, only bounded by silence.
        if !self.anchored || unseen >= MAX_UNSEEN {
            self.anchor(observation.delta, place, sample.age);
            return class;
        }
        let innovation = self
            .motion
            .missed_by(place, sample.age.to_bits(), class.half_age_spread);
        let Some(innovation) = credible(innovation) else {
            self.restart(observation.delta);
            return solved.gains.class(false, self.class);
        };
        self.motion
            .correct(innovation, &class.gains, &solved.gains.scale);
        if drive
            && self
                .supervisor
                .weigh(innovation, class.per_sigma, &solved.config.supervision)
        {
            return solved.gains.class(false, self.class);
        }
        class
    }

    /// The first edge in a long time, or since the state was lost, gives the position alone, by a velocity that is not
    /// far off.
    #[cold]
    #[inline(never)]
    fn anchor(&mut self, delta: i32, place: i32, age: Span) {
        let moved = delta.wrapping_shl(Velocity::FRAC_NBITS);
        let slip = high(self.motion.velocity).saturating_sub(moved);
        if slip.unsigned_abs() > MOST_SLIP {
            let placed = self.placed;
            self.restart(delta);
            self.placed = placed;
        }
        let missed = self.motion.missed_by(place, age.to_bits(), 0);
        self.motion.position = self.motion.position.wrapping_add(missed);
        self.anchored = true;
    }

    /// A tick without a sample.
    #[inline(never)]
    pub(super) fn without_edge(
        &mut self,
        solved: &Solved,
        observation: &Observation<'_>,
        estimate: &mut Estimate,
    ) {
        self.hold(solved, observation);
        if self.motion.is_wild() {
            self.restart(observation.delta);
        }
        let drive = self.supervisor.model() == Model::Drive;
        let class = solved.gains.class(drive, self.class);
        let is_still = self.is_resting(&solved.config) && self.motion.velocity == 0;
        let lag = if is_still { Lag::ZERO } else { class.lag };
        self.estimate(observation, lag, estimate);
    }

    /// Without a sample the shaft is within the discrete all the same; a position that left it is brought
    /// back to its nearer end.
    #[inline]
    fn hold(&mut self, solved: &Solved, observation: &Observation<'_>) {
        self.silence = if observation.delta == 0 {
            self.silence.saturating_add(1)
        } else {
            0
        };
        self.unseen = self.unseen.saturating_add(1);
        let placed = i64::from(self.placed).wrapping_shl(32);
        let position = self.motion.position.wrapping_sub(placed);
        let outside = if position < TOLERANCE.wrapping_neg() {
            TOLERANCE.wrapping_neg().wrapping_sub(position)
        } else if position > ONE + TOLERANCE {
            (ONE + TOLERANCE).wrapping_sub(position)
        } else {
            return;
        };
        let Some(outside) = credible(outside) else {
            self.restart(observation.delta);
            return;
        };
        let drive = self.supervisor.model() == Model::Drive;
        let gains = &solved.gains.class(drive, HOLD_CLASS).gains;
        self.motion.correct(outside, gains, &solved.gains.scale);
        // What is taken for having stopped the shaft must not drive it back.
        let inward = (self.motion.acceleration ^ i64::from(outside)) >= 0;
        if !drive && inward {
            self.motion.acceleration = 0;
        }
    }
}

/// Class of the density of edges: of `edges` now, after `unseen` ticks without. Where it lies between two octaves it is
/// the lower one: gains for a longer time than that which passed are stable, those for a shorter one need not be.
#[inline]
const fn density(edges: u32, unseen: u32) -> usize {
    // The octave of the ticks and one more, less that of the edges, by their leading zeros.
    let octaves = edges.leading_zeros().wrapping_sub(unseen.leading_zeros());
    octaves.wrapping_add(const { ONE_A_TICK as u32 + 1 }) as usize
}

/// Place of a sample relative to the count, Q15.16 d.
#[inline]
const fn relative(observation: &Observation<'_>, sample: &EdgeSample) -> i32 {
    // No further than the motion of a tick and the map's correction: the low words suffice.
    let count = (observation.count as i32).wrapping_shl(Position::FRAC_NBITS);
    (sample.position.to_bits() as i32).wrapping_sub(count)
}

/// A difference of positions within ±8 d, which is that of a motion and not of a jump of the count, as an innovation.
#[inline]
const fn credible(difference: i64) -> Option<i32> {
    const MOST: u32 = 8 << (PLACE_FRAC - 32);
    const SHIFT: u32 = PLACE_FRAC - INNOVATION_FRAC;
    let high = high(difference);
    if high.cast_unsigned().wrapping_add(MOST) < 2 * MOST {
        // By words: the compiler then multiplies what comes of it as 32 bits.
        let low = (difference as u32).wrapping_shr(SHIFT).cast_signed();
        Some(high.wrapping_shl(32 - SHIFT) | low)
    } else {
        None
    }
}
