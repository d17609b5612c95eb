//! What the edges of a tick tell: where the shaft was, and when.
//!
//! An edge is worth more than a count: at its instant the shaft was *at* a boundary, not somewhere in a
//! discrete. Where every edge of a tick was captured, their mean place and mean time make one sample,
//! right to the noise of an edge over √n; where the hardware keeps one stamp, the last edge is the
//! sample. A tick whose edges do not explain its count (a reversal within it, edges lost) gives what is
//! certain: the last edge if the count moved and the direction is known, else nothing.
//!
//! With an encoder map an edge stands for the place where it really lies, as far as the map knows it.

use crate::capture::{EdgeTimes, Observation};
use crate::encoder_map::tie::{MapHealth, MapState, MapTie};
use crate::encoder_map::{Direction, EncoderMap, Residual};
use crate::uncertainty::{EdgeErrors, EdgeNoise};
use crate::units::{Position, RangeError, TICK_HZ, TIMER_HZ, checked};

/// A span of time within some ticks of now, in ticks: 3.7e-9 fine; spans of [`MAX_SPAN_TICKS`] and more
/// are given as just that.
pub type Span = fixed::types::U4F28;

/// Longest [`Span`], ticks.
pub const MAX_SPAN_TICKS: u32 = 8;

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

/// What the reader has to know: the timer, and how well the encoder's edges are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeConfig {
    /// Clocks of the edge timer to ticks.
    pub scale: EdgeScale,
    /// Noise of the edges.
    pub noise: EdgeNoise,
}

impl EdgeConfig {
    /// For a control rate of `tick_hz`, a timer of `timer_hz` and an encoder with `errors`.
    ///
    /// # Errors
    /// [`RangeError`] for a rate outside 100 Hz to 40 kHz, a clock outside 1 to 250 MHz, or an error of the
    /// encoder out of range.
    pub fn new(tick_hz: f64, timer_hz: f64, errors: &EdgeErrors) -> Result<Self, RangeError> {
        Ok(Self {
            scale: EdgeScale::new(tick_hz, timer_hz)?,
            noise: EdgeNoise::new(errors, tick_hz, timer_hz)?,
        })
    }
}

/// Ticks in a clock of the edge timer.
///
/// A span is counted in parts of a clock, 2^`part_bits` of them, so that a tick has 2²⁸ to 2²⁹ parts; one
/// 32 × 32-bit product then gives ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeScale {
    part_bits: u32,
    /// 2⁶⁰ over the parts of a tick: right to 2⁻³².
    ticks_per_part: u32,
    /// Clocks in [`MAX_SPAN_TICKS`].
    max_clocks: u32,
    /// Clocks in a tick; 0 where they are not a whole number to 2⁻²⁴ of a tick.
    clocks_per_tick: u32,
    /// Those as a span.
    tick: Span,
}

impl EdgeScale {
    /// The scale of a timer of `timer_hz` at a control rate of `tick_hz`.
    ///
    /// # Errors
    /// [`RangeError`] for a rate outside 100 Hz to 40 kHz or a clock outside 1 to 250 MHz.
    pub fn new(tick_hz: f64, timer_hz: f64) -> Result<Self, RangeError> {
        let tick_hz = checked("tick_hz", tick_hz, TICK_HZ.0, TICK_HZ.1)?;
        let timer_hz = checked("timer_hz", timer_hz, TIMER_HZ.0, TIMER_HZ.1)?;
        let clocks_per_tick = timer_hz / tick_hz;
        let whole_bits = (clocks_per_tick as u32).ilog2();
        let part_bits = 28_u32.wrapping_sub(whole_bits);
        let parts_per_tick = libm::ldexp(clocks_per_tick, part_bits.cast_signed());
        let whole = libm::round(clocks_per_tick);
        let is_whole = (whole - clocks_per_tick).abs() <= libm::ldexp(clocks_per_tick, -24);
        let scale = Self {
            clocks_per_tick: if is_whole { whole as u32 } else { 0 },
            tick: Span::ZERO,
            part_bits,
            ticks_per_part: libm::round(libm::ldexp(1.0, 60) / parts_per_tick) as u32,
            max_clocks: (clocks_per_tick * f64::from(MAX_SPAN_TICKS) * (1.0 - 1e-9)) as u32,
        };
        Ok(Self {
            tick: scale.span(scale.clocks_per_tick),
            ..scale
        })
    }

    /// A span of `clocks`.
    #[must_use]
    pub const fn span(self, clocks: u32) -> Span {
        if clocks >= self.max_clocks {
            return LONGEST;
        }
        self.span_of_parts(clocks.wrapping_shl(self.part_bits))
    }

    /// The mean of `count` spans that add up to `clocks`; `count` is 1 to 2 047.
    fn mean_span(self, clocks: u64, count: u32) -> Span {
        // Beyond 32 bits the mean is so large that what is cut off does not matter.
        let (clocks, coarse) = match u32::try_from(clocks) {
            Ok(clocks) => (clocks, 0),
            Err(_) => (clocks.wrapping_shr(COARSE_BITS) as u32, COARSE_BITS),
        };
        let whole = clocks.checked_div(count).unwrap_or(0);
        if whole >= self.max_clocks.wrapping_shr(coarse) {
            return LONGEST;
        }
        let rest = clocks.wrapping_sub(whole.wrapping_mul(count));
        let fine_bits = if self.part_bits < REST_BITS {
            self.part_bits
        } else {
            REST_BITS
        };
        let fraction = rest
            .wrapping_shl(fine_bits)
            .checked_div(count)
            .unwrap_or(0)
            .wrapping_shl(self.part_bits.wrapping_sub(fine_bits));
        let parts = whole.wrapping_shl(self.part_bits).wrapping_add(fraction);
        self.span_of_parts(parts.wrapping_shl(coarse))
    }

    const fn span_of_parts(self, parts: u32) -> Span {
        let product = (parts as u64).wrapping_mul(self.ticks_per_part as u64);
        Span::from_bits(product.wrapping_shr(32) as u32)
    }
}

const LONGEST: Span = Span::from_bits(MAX_SPAN_TICKS << Span::FRAC_NBITS);
/// Clocks are cut by so many bits where their sum needs more than 32.
const COARSE_BITS: u32 = 8;
/// A rest of at most 2 047 may be shifted by so much.
const REST_BITS: u32 = 20;

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
        let ages = sum_of_ages(observation, times, edges);
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

/// Ages below [`MAX_SPAN_TICKS`] of so many edges add up in 32 bits at every clock and rate.
const CHUNK: usize = 128;

/// How long the `edges` edges at `times` lie before the sample, added up, clocks.
fn sum_of_ages(observation: &Observation<'_>, times: [&[u32]; 2], edges: u32) -> u64 {
    let now = observation.sampled_at as u32;
    // None is older than the tick.
    if observation.elapsed.checked_mul(edges).is_some() {
        let [older, newer] = times.map(wrapping_sum);
        let sum = older.wrapping_add(newer);
        return u64::from(now.wrapping_mul(edges).wrapping_sub(sum));
    }
    chunked_sum_of_ages(now, times)
}

/// The same where it needs more than 32 bits.
#[cold]
fn chunked_sum_of_ages(now: u32, times: [&[u32]; 2]) -> u64 {
    let chunks = times.into_iter().flat_map(|times| times.chunks(CHUNK));
    chunks.fold(0, |total, times| {
        let ages = now
            .wrapping_mul(times.len() as u32)
            .wrapping_sub(wrapping_sum(times));
        total.wrapping_add(u64::from(ages))
    })
}

/// The sum of all, modulo 2³². A function of its own, four at a time, in pairs: with its registers to itself an edge
/// costs little more than its addition, and eights were so unrolled that they did not fit in them.
#[inline(never)]
fn wrapping_sum(times: &[u32]) -> u32 {
    let (fours, rest) = times.as_chunks::<4>();
    let mut sum = 0_u32;
    for &[a, b, c, d] in fours {
        let (one, other) = (a.wrapping_add(b), c.wrapping_add(d));
        sum = sum.wrapping_add(one.wrapping_add(other));
    }
    rest.iter().copied().fold(sum, u32::wrapping_add)
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
