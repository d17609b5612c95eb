//! What the edges of a tick tell: where the shaft was, and when.
//!
//! An edge is worth more than a count: at its instant the shaft was *at* a boundary, not somewhere in a
//! discrete. Where every edge of a tick was captured, their mean place and mean time make one sample,
//! right to the noise of an edge over √n; where the hardware keeps one stamp, the last edge is the
//! sample. A tick whose edges do not explain its count (a reversal within it, edges lost) gives what is
//! certain: the last edge if the count moved and the direction is known, else nothing.
//!
//! With an encoder map an edge stands for the place where it really lies, as far as the map knows it.
//!
//! `scale` makes ticks of clocks, `ages` adds up the times of a tick's edges.

mod ages;
mod scale;

pub use scale::{EdgeConfig, EdgeScale, MAX_SPAN_TICKS, Span};

use crate::capture::{EdgeTimes, Observation};
use crate::encoder_map::tie::{MapHealth, MapState, MapTie};
use crate::encoder_map::{Direction, EncoderMap, Residual};
use crate::uncertainty::EdgeNoise;
use crate::units::Position;
use scale::LONGEST;

/// A place of the shaft and the time at which it was there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeSample {
    /// Place, d: the mean boundary that the edges stand for, with the mean of their errors by the map.
    pub position: Position,
    /// What the encoder's errors by the map are of it, Q15.16 d: from where the count alone puts the edges.
    pub correction: i32,
    /// How long before the sampling instant, ticks.
    pub age: Span,
    /// Edges that it is the mean of, 1 to 2 047.
    pub edges: u32,
}

/// Reads the edges of each tick.
#[derive(Clone, Debug)]
pub struct EdgeReader<'m> {
    config: EdgeConfig,
    tie: Option<MapTie<'m>>,
    /// Noise of the edges where the map is in use.
    mapped: EdgeNoise,
}

impl<'m> EdgeReader<'m> {
    /// A reader without a map.
    #[must_use]
    pub const fn new(config: EdgeConfig) -> Self {
        Self {
            config,
            tie: None,
            mapped: config.noise,
        }
    }

    /// The same with a map, which waits for its index.
    #[must_use]
    pub fn with_map(mut self, map: EncoderMap<'m>) -> Self {
        self.set_map(Some(map));
        self
    }

    /// Takes a map, which waits for its index, or does without. Outside the tick.
    pub fn set_map(&mut self, map: Option<EncoderMap<'m>>) {
        self.tie = map.map(MapTie::new);
        self.weigh_map();
    }

    /// Takes another configuration; the map stays tied. Outside the tick.
    pub fn reconfigure(&mut self, config: EdgeConfig) {
        self.config = config;
        self.weigh_map();
    }

    /// What the map leaves of the edges' places.
    fn weigh_map(&mut self) {
        if let Some(tie) = &self.tie {
            let Residual {
                short_wave_d,
                slope,
                curvature_per_d,
                ..
            } = *tie.map().residual();
            self.mapped = self.config.noise.with_placement(
                f64::from(short_wave_d),
                f64::from(slope),
                f64::from(curvature_per_d),
            );
        }
    }

    /// How well the edges are known.
    #[must_use]
    pub fn noise(&self) -> &EdgeNoise {
        match &self.tie {
            Some(tie) if tie.state() == MapState::Tied => &self.mapped,
            _ => &self.config.noise,
        }
    }

    /// The map in use.
    #[must_use]
    pub fn map(&self) -> Option<&EncoderMap<'m>> {
        self.tie.as_ref().map(MapTie::map)
    }

    /// How far the map can be used; `None` without one.
    #[must_use]
    pub fn map_state(&self) -> Option<MapState> {
        self.tie.as_ref().map(MapTie::state)
    }

    /// What the indexes showed since the map was set; without one, nothing.
    #[must_use]
    pub fn map_health(&self) -> MapHealth {
        self.tie.as_ref().map(MapTie::health).unwrap_or_default()
    }

    /// Takes notice of a tick, once and before its edges are read.
    #[inline]
    pub fn note(&mut self, observation: &Observation<'_>) {
        if let Some(tie) = &mut self.tie {
            tie.note(observation);
        }
    }

    /// Errors of the boundary that was passed last in the tick last [noted](Self::note), Q.16 d, for a motion forward and one
    /// backward; none without a map tied to the index.
    #[must_use]
    pub fn last_errors(&self) -> Option<[i32; 2]> {
        let tie = self.tie.as_ref()?;
        let errors = || [(0, Direction::Forward), (1, Direction::Backward)];
        (tie.state() == MapState::Tied)
            .then(|| errors().map(|(ahead, direction)| tie.error(ahead, direction)))
    }

    /// Error of the boundary at which the index of the tick last [noted](Self::note) was latched, Q.16 d; 0 without an
    /// index or a map tied to it.
    #[must_use]
    pub fn index_error(&self, observation: &Observation<'_>) -> i32 {
        let (Some(tie), Some(latch)) = (&self.tie, observation.index()) else {
            return 0;
        };
        if tie.state() != MapState::Tied || observation.delta == 0 {
            return 0;
        }
        let direction = Direction::of(observation.delta);
        let above = i64::from(direction == Direction::Backward);
        let boundary = latch.count.wrapping_add(above);
        tie.error(boundary.wrapping_sub(observation.count) as i32, direction)
    }

    /// Time from the previous sampling instant to this one.
    #[must_use]
    #[inline]
    pub const fn elapsed(&self, observation: &Observation<'_>) -> Span {
        if self.is_punctual(observation) {
            return self.config.scale.tick;
        }
        self.config.scale.span(observation.elapsed)
    }

    /// Ticks with `frac` fractional bits, 28 at most, in so many clocks; none from [`MAX_SPAN_TICKS`] on.
    #[must_use]
    pub fn ticks_of(&self, clocks: u32, frac: u32) -> Option<u32> {
        let span = self.config.scale.span(clocks);
        let shift = Span::FRAC_NBITS.saturating_sub(frac);
        (span < LONGEST).then(|| span.to_bits().wrapping_shr(shift))
    }

    /// True if that time is a tick to 2⁻²⁴ of it. False says nothing: where a tick is not a
    /// whole number of clocks, it is for [`Self::elapsed`] to tell.
    #[inline]
    #[must_use]
    pub const fn is_punctual(&self, observation: &Observation<'_>) -> bool {
        observation.elapsed == self.config.scale.clocks_per_tick
    }

    /// The sample that the edges of the tick make; `None` without an edge, or where they do not tell.
    ///
    /// The tick is the one last [noted](Self::note).
    // Inlined for the last edge, which costs less than to hand its sample over in memory; the mean is a call.
    #[must_use]
    #[inline(always)]
    pub fn sample(&self, observation: &Observation<'_>) -> Option<EdgeSample> {
        match observation.edge_times() {
            EdgeTimes::None => None,
            EdgeTimes::Last { age } => Some(self.last(observation, age)),
            EdgeTimes::All(times) => Some(self.mean(observation, times)),
        }
    }

    /// The last edge: boundary `count` when going forward, the one above when going backward.
    #[inline]
    fn last(&self, observation: &Observation<'_>, age: u32) -> EdgeSample {
        let direction = Direction::of(observation.delta);
        let above = i32::from(direction == Direction::Backward);
        let boundary = observation.count.wrapping_add(i64::from(above));
        let error = match &self.tie {
            Some(tie) => tie.error(above, direction),
            None => 0,
        };
        EdgeSample {
            position: place(boundary.wrapping_shl(Position::FRAC_NBITS), error),
            correction: error,
            age: self.config.scale.span(age),
            edges: 1,
        }
    }

    /// The mean of all edges: from count c₀ to c₁ the boundaries passed are the |c₁ − c₀| ones between,
    /// with the mean (c₀ + c₁ + 1)/2 in either direction.
    #[inline(never)]
    fn mean(&self, observation: &Observation<'_>, times: [&[u32]; 2]) -> EdgeSample {
        let edges = observation.delta.unsigned_abs();
        let doubled = observation
            .count
            .wrapping_mul(2)
            .wrapping_sub(i64::from(observation.delta))
            .wrapping_add(1);
        let error = match &self.tie {
            Some(tie) => {
                // From the lowest of them on upwards.
                let lowest = 1_i32.wrapping_sub(observation.delta.max(0));
                let direction = Direction::of(observation.delta);
                rounded_mean(tie.sum(lowest, edges, direction), edges)
            }
            None => 0,
        };
        let ages = ages::sum(observation, times, edges);
        EdgeSample {
            position: place(doubled.wrapping_shl(Position::FRAC_NBITS - 1), error),
            correction: error,
            age: self.config.scale.mean_span(ages, edges),
            edges,
        }
    }
}

/// A place by the count, Q.16 d, with the error of the encoder there.
fn place(boundary: i64, error: i32) -> Position {
    Position::from_bits(boundary.wrapping_add(i64::from(error)))
}

/// `sum` / `count`, to nearest; |sum| is below 2³¹ by more than `count`, which is 1 to 2 047.
fn rounded_mean(sum: i32, count: u32) -> i32 {
    let count = count.cast_signed();
    let half = count.wrapping_shr(1);
    let half = if sum < 0 { half.wrapping_neg() } else { half };
    sum.wrapping_add(half).checked_div(count).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::rounded_mean;

    #[test]
    fn a_mean_error_is_rounded_to_nearest_on_both_sides() {
        for (sum, count, mean) in [(7, 3, 2), (8, 3, 3), (7, 2, 4), (0, 5, 0), (1, 1, 1)] {
            assert_eq!(rounded_mean(sum, count), mean);
            assert_eq!(rounded_mean(-sum, count), -mean);
        }
        let largest = 11 * 65_536 * 2047;
        assert_eq!(rounded_mean(-largest, 2047), -11 * 65_536);
    }
}
