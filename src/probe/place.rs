//! Where a touch was: what is gathered for it, and what is made of that.

use super::config::{Config, TIME_FRAC};
use super::trigger::Edge;
use super::{Noted, Probe, Sight, Stage, Touch, fit};
use crate::units::{Position, Variance, Velocity};

/// So many samples after the contact tell enough of it.
const SAMPLES_AFTER: u32 = 8;

/// A place by the edges lies no farther from what the hardware counted than the encoder's own errors, d.
const MOST_OFF: Position = Position::from_bits(12 << Position::FRAC_NBITS);

impl Probe {
    /// Notes where the shaft was, as long as that may tell where a touch was.
    pub(super) fn gather(&mut self, sight: &Sight<'_>) {
        let is_open = match (self.stage, &self.edge) {
            (Stage::Approach, None) => true,
            (Stage::Approach | Stage::Stop, Some(noted)) => noted.instant.is_some_and(|instant| {
                let since = self.history.now().wrapping_sub(instant);
                since < self.config.sample.saturating_mul(SAMPLES_AFTER)
            }),
            _ => false,
        };
        if is_open {
            let elapsed = sight.edges.elapsed(sight.observation);
            let sample = sight.edges.sample(sight.observation);
            self.history.note(elapsed, sample, self.config.sample);
        }
    }

    /// Keeps the edge that may become a touch, and lets it go if it was a glitch.
    pub(super) fn note_edge(&mut self, sight: &Sight<'_>) {
        let Some(edge) = self.trigger.pending() else {
            if !self.trigger.is_closed() {
                self.edge = None;
            }
            return;
        };
        if self.edge.is_some_and(|noted| noted.edge == edge) {
            return;
        }
        let clocks = sight.observation.sampled_at.wrapping_sub(edge.latch.time);
        let age = u32::try_from(clocks)
            .ok()
            .and_then(|clocks| sight.edges.ticks_of(clocks, TIME_FRAC));
        self.edge = Some(Noted {
            edge,
            tick: sight.tick,
            instant: age.map(|age| self.history.now().wrapping_sub(age)),
        });
    }

    /// Where the touch was.
    pub(super) fn find(&mut self, noted: &Noted, sight: &Sight<'_>) {
        let touch = self.by_edges(noted, sight);
        self.touch = Some(touch.unwrap_or_else(|| Touch {
            tick: noted.tick,
            ..by_count(&noted.edge, sight, &self.config)
        }));
        self.note_touch();
    }

    /// By the samples about it; none where there are too few, or where they contradict what the hardware counted.
    fn by_edges(&self, noted: &Noted, sight: &Sight<'_>) -> Option<Touch> {
        let Noted {
            edge,
            tick,
            instant,
        } = *noted;
        if !edge.is_latched {
            return None;
        }
        let Config {
            delay,
            sample,
            slope_reach,
            ..
        } = self.config;
        let instant = instant?.wrapping_sub(delay.cast_unsigned());
        let counted = middle_of(edge.latch.count);
        let noise = sight.edges.noise();
        let found = fit::at(&self.history, instant, sample, counted, noise)?;
        let delayed = way_in(found.velocity, delay);
        let off = found
            .place
            .saturating_add(delayed)
            .saturating_sub(counted)
            .saturating_abs();
        if off > MOST_OFF {
            return None;
        }
        let variance = found
            .variance
            .saturating_add(noise.of_place(slope_reach))
            .saturating_add(self.config.jitter_variance(found.velocity));
        Some(Touch {
            raw: found.place,
            position: found.place,
            variance: Variance::from_bits(variance),
            velocity: found.velocity,
            time: edge.latch.time,
            tick,
            overtravel: Position::ZERO,
            edges: found.edges,
        })
    }
}

/// The middle of a discrete.
const fn middle_of(count: i64) -> Position {
    Position::from_bits(
        count
            .wrapping_shl(Position::FRAC_NBITS)
            .wrapping_add(1 << (Position::FRAC_NBITS - 1)),
    )
}

/// Way at `velocity` in a time with [`TIME_FRAC`].
fn way_in(velocity: Velocity, time: i32) -> Position {
    let way = i64::from(velocity.to_bits()).wrapping_mul(i64::from(time));
    Position::from_bits(way.wrapping_shr(Velocity::FRAC_NBITS + TIME_FRAC - Position::FRAC_NBITS))
}

/// A touch by what the hardware counted and what is estimated of the velocity.
pub(super) fn by_count(edge: &Edge, sight: &Sight<'_>, config: &Config) -> Touch {
    let velocity = sight.estimate.velocity;
    let raw = middle_of(edge.latch.count).saturating_sub(way_in(velocity, config.delay));
    // Within a count, and within a tick where nothing latched: a twelfth of each squared.
    const OF_COUNT: u64 = (1 << 48) / 12;
    let of_tick = if edge.is_latched {
        0
    } else {
        let speed = u64::from(velocity.to_bits().unsigned_abs());
        speed.wrapping_mul(speed).wrapping_shr(3)
    };
    // v²/12 in 2⁻⁴⁸ is 2⁸/12 of its bits, and 2⁸/12 is 171/8.
    let of_tick = of_tick.saturating_mul(171);
    let variance = OF_COUNT
        .saturating_add(of_tick)
        .saturating_add(config.jitter_variance(velocity));
    Touch {
        raw,
        position: raw,
        variance: Variance::from_bits(variance),
        velocity,
        time: edge.latch.time,
        tick: sight.tick,
        overtravel: Position::ZERO,
        edges: 0,
    }
}
