//! Where the shaft was at an instant: the least-squares quadratic through the samples about it.
//!
//! The equations are those of [`polynomial`](crate::estimator::polynomial), in exact integers, with the origin at the instant
//! that is asked for. Times go onto a grid of 2⁵ to 2⁶ steps over the samples' span; what is left of a sample's time is bridged by the motion
//! found in a first pass. With P₁ and P₂ the line and the parabola that are orthogonal over the samples, the variance of the
//! place is
//!
//! σ²·(1/w + P₁(0)²/ΣP₁² + P₂(0)²/ΣP₂²),
//!
//! σ that of an edge: least in the samples' middle, and so better with samples after the touch than with those before it
//! alone. To it comes what the motion has besides a quadratic; where the samples' own distances from it show clearly more,
//! that counts.

use super::config::TIME_FRAC;
use super::history::{CAPACITY, History, OLDEST, Sample};
use crate::estimator::polynomial::fit::{Fit, MOST_WEIGHT, Sums, wide};
use crate::estimator::polynomial::geometry::{BETA_FRAC, Geometry};
use crate::estimator::polynomial::ratio::Reciprocal;
use crate::estimator::polynomial::window::PLACE_FRAC;
use crate::uncertainty::EdgeNoise;
use crate::units::{Position, Velocity};

/// Samples older than so many ms count only where there are fewer than [`ENOUGH`].
const WINDOW_SAMPLES: u32 = 20;
/// As many make a good quadratic.
const ENOUGH: usize = 8;
/// What a motion has besides a quadratic in the time of a fit, 2⁻⁴⁸ d²: 0.003 d rms, from the touches of `tests/probe/figures.rs` on the
/// machine 16K20F3 Z.
const OF_MOTION: u64 = 2_533_274_790;
/// What the samples show of the variance of an edge counts from so many times the known one on: by chance a score of samples
/// shows 2.5 times as much once in a thousand.
const SIGNIFICANT: u32 = 4;
/// Samples farther from the fit count as this far, d with [`PLACE_FRAC`].
const MOST_SCATTER: u64 = 1 << 16;
/// Fractional bits of the gain of the variance.
const GAIN_FRAC: u32 = 28;
/// Steps of the grid in the unit of time that the fit takes for a tick: 2¹.
const GRID_BITS: u32 = 1;

/// What was found.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// Place, d with the wrap of [`Sample::place`] undone from the place that was asked near.
    pub place: Position,
    /// d/tick.
    pub velocity: Velocity,
    /// Of the place by the noise of the edges, 2⁻⁴⁸ d².
    pub variance: u64,
    /// Edges.
    pub edges: u32,
}

/// The samples that are used, and their grid.
struct Grid<'a> {
    history: &'a History,
    used: usize,
    origin: u32,
    /// Place that others are counted from.
    base: i32,
    /// A step is 2^shift of [`TIME_FRAC`].
    shift: u32,
}

/// Where the shaft was at `instant` (as [`History::now`] counts), near `about`; none with fewer than two samples.
pub fn at(
    history: &History,
    instant: u32,
    sample: u32,
    about: Position,
    noise: &EdgeNoise,
) -> Option<Found> {
    let grid = Grid::new(history, instant, sample)?;
    let mut motion = (grid.slope()?, 0);
    let mut sums = grid.sums(motion);
    let geometry = Geometry::of(&sums);
    let mut fit = Fit::new(&sums, &geometry, motion.0, motion.1);
    for _ in 0..2 {
        motion = (fit.velocity, fit.acceleration);
        sums = grid.sums(motion);
        fit = Fit::new(&sums, &geometry, motion.0, motion.1);
    }
    let velocity = grid.per_tick(fit.velocity);
    let edges = grid
        .samples()
        .fold(0, |sum: u32, s| sum.saturating_add(s.edges));
    let base = i64::from(grid.base).wrapping_shl(Position::FRAC_NBITS - PLACE_FRAC);
    let wrapped = base.wrapping_add(fit.place);
    // The samples' places wrap at 2¹⁹ d: the nearest one to where it must be about.
    const WRAP: u32 = 32 + Position::FRAC_NBITS - PLACE_FRAC;
    let off = wrapped
        .wrapping_sub(about.to_bits())
        .wrapping_shl(64 - WRAP)
        .wrapping_shr(64 - WRAP);
    let of_edge = noise.of_edge(velocity.to_bits());
    let of = |of_edge| variance(&sums, &geometry, of_edge, edges);
    let known = of(of_edge).saturating_add(OF_MOTION);
    let seen = grid.scatter(&fit);
    let variance = if seen > of_edge.saturating_mul(SIGNIFICANT) {
        known.max(of(seen))
    } else {
        known
    };
    Some(Found {
        place: Position::from_bits(about.to_bits().wrapping_add(off)),
        velocity,
        variance,
        edges,
    })
}

impl<'a> Grid<'a> {
    fn new(history: &'a History, origin: u32, sample: u32) -> Option<Self> {
        let window = sample.saturating_mul(WINDOW_SAMPLES);
        let age = |s: &Sample| origin.wrapping_sub(s.time).cast_signed();
        let is_used = |(at, s): &(usize, &Sample)| {
            let age = i64::from(age(s));
            age <= i64::from(window) || *at < ENOUGH && age <= i64::from(OLDEST)
        };
        let used = history.newest_first().enumerate().take_while(is_used);
        let span = used.clone().map(|(_, s)| age(s).unsigned_abs()).max()?;
        let used = used.count();
        let base = history.newest_first().next()?.place;
        Some(Self {
            history,
            used,
            origin,
            base,
            shift: 26_u32.saturating_sub(span.leading_zeros()),
        })
    }

    fn samples(&self) -> impl Iterator<Item = &Sample> + Clone {
        self.history.newest_first().take(self.used.min(CAPACITY))
    }

    /// From the oldest to the newest, Q12.20 d in two steps.
    fn slope(&self) -> Option<i32> {
        let newest = self.samples().next()?;
        let oldest = self.samples().last()?;
        let time = newest.time.wrapping_sub(oldest.time).cast_signed();
        if self.used < 2 || time <= 0 {
            return None;
        }
        let way = i64::from(newest.place.wrapping_sub(oldest.place));
        let by_time = Reciprocal::new(i64::from(time).unsigned_abs());
        let way = way.wrapping_shl(Velocity::FRAC_NBITS - PLACE_FRAC);
        Some(by_time.ratio(way, self.shift.wrapping_add(GRID_BITS)))
    }

    /// The samples on the grid, bridged by `motion` (velocity and acceleration at the origin): step, place from the base,
    /// edges.
    fn gridded(&self, motion: (i32, i32)) -> impl Iterator<Item = (i32, i32, u16)> {
        let (velocity, acceleration) = motion;
        let (shift, origin, base) = (self.shift, self.origin, self.base);
        let unit = shift.wrapping_add(GRID_BITS);
        let half = 1_i32.wrapping_shl(shift).wrapping_shr(1);
        self.samples().map(move |sample| {
            let time = sample.time.wrapping_sub(origin).cast_signed();
            let step = time.wrapping_add(half).wrapping_shr(shift);
            let rest = time.wrapping_sub(step.wrapping_shl(shift));
            let middle = time.wrapping_sub(rest.wrapping_shr(1));
            let gained = wide(acceleration, middle).wrapping_shr(unit.wrapping_add(4)) as i32;
            let bridged = wide(velocity.wrapping_add(gained), rest)
                .wrapping_shr(unit.wrapping_add(Velocity::FRAC_NBITS - PLACE_FRAC));
            let place = sample.place.wrapping_sub(base);
            let edges = sample.edges.min(u32::from(u16::MAX)) as u16;
            (step, place.wrapping_sub(bridged as i32), edges)
        })
    }

    fn sums(&self, motion: (i32, i32)) -> Sums {
        let mut sums = Sums::default();
        for (step, place, edges) in self.gridded(motion) {
            sums.add(step, place, edges);
        }
        sums
    }

    /// Variance of an edge as the samples' distances from `fit` show it, Q2.30 d²; 0 where there are too few.
    fn scatter(&self, fit: &Fit) -> u32 {
        const OF_VELOCITY: u32 = Velocity::FRAC_NBITS + GRID_BITS - PLACE_FRAC;
        const OF_ACCELERATION: u32 = 24 + 2 * GRID_BITS + 1 - PLACE_FRAC;
        let Some(freedom) = (self.used as u32)
            .checked_sub(3)
            .filter(|freedom| *freedom >= 3)
        else {
            return 0;
        };
        let start = fit.place.wrapping_shr(Position::FRAC_NBITS - PLACE_FRAC);
        let motion = (fit.velocity, fit.acceleration);
        let squares = self
            .gridded(motion)
            .fold(0_u64, |sum, (step, place, edges)| {
                let fitted = start
                    .wrapping_add(wide(fit.velocity, step).wrapping_shr(OF_VELOCITY))
                    .wrapping_add(
                        wide(fit.acceleration, step.wrapping_mul(step))
                            .wrapping_shr(OF_ACCELERATION),
                    );
                let off = i64::from(place).wrapping_sub(fitted).unsigned_abs();
                let off = off.min(MOST_SCATTER);
                let weight = u64::from(edges.min(MOST_WEIGHT));
                sum.saturating_add(off.wrapping_mul(off).wrapping_mul(weight))
            });
        // Q.26 to Q.30.
        let squares = squares.saturating_mul(16).min(u64::from(u32::MAX)) as u32;
        squares.checked_div(freedom).unwrap_or(0)
    }

    /// From d in two steps to d/tick, both Q12.20.
    fn per_tick(&self, velocity: i32) -> Velocity {
        let unit = self.shift.wrapping_add(GRID_BITS);
        let bits = i64::from(velocity)
            .wrapping_shl(TIME_FRAC)
            .wrapping_shr(unit);
        let most = i64::from(i32::MAX);
        Velocity::from_bits(bits.max(most.wrapping_neg()).min(most) as i32)
    }
}

/// Variance of the place at the origin, 2⁻⁴⁸ d², where that of an edge is `of_edge` (Q2.30).
fn variance(sums: &Sums, geometry: &Geometry, of_edge: u32, edges: u32) -> u64 {
    let weight = sums.weight.cast_unsigned().max(1);
    let mut gain = 1_u32
        .wrapping_shl(GAIN_FRAC)
        .checked_div(weight)
        .unwrap_or(0);
    let square =
        |value: i32| u64::from(value.unsigned_abs()).wrapping_mul(u64::from(value.unsigned_abs()));
    let t1 = sums.t1;
    // t₁² is below 2³¹.
    let line = (square(t1) as u32).checked_div(weight).unwrap_or(0);
    gain = gain.saturating_add(geometry.by_uu.size(u64::from(line), GAIN_FRAC));
    if let Some(by_spread) = geometry.by_spread {
        let turned = wide(geometry.beta, t1).wrapping_shr(BETA_FRAC) as i32;
        let middle = sums
            .t2
            .wrapping_sub(turned)
            .checked_div(sums.weight)
            .unwrap_or(0);
        let bend = square(middle).wrapping_mul(u64::from(weight));
        gain = gain.saturating_add(by_spread.size(bend, GAIN_FRAC));
    }
    let of_sample = u64::from(of_edge).wrapping_mul(u64::from(gain));
    let share = weight
        .wrapping_shl(16)
        .checked_div(edges.max(1))
        .unwrap_or(0);
    // 2⁻⁵⁸ to 2⁻³², times 2⁻¹⁶.
    of_sample.wrapping_shr(26).saturating_mul(u64::from(share))
}
