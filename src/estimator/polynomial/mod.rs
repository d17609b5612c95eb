//! Local polynomial: the least-squares quadratic over the last W ticks of edge samples, at their true times.
//!
//! A sample is a place and the time at which the shaft was there ([`crate::edges`]), so neither the rounding to
//! whole counts nor jitter of the sampling instant enters. Times are held on a grid of half a tick; what is left of a
//! sample's time, at most a quarter of a tick, is bridged with the velocity and acceleration found last. Where the
//! samples stand one a tick, as they do above 1 d/tick, sums slide in constant time (`regular.rs`); elsewhere the normal
//! equations are solved anew (`fit.rs`); both in exact integers.
//!
//! The acceleration is that of the samples' middle. Position and velocity are answered for the middle or,
//! extrapolated by the quadratic, for the sampling instant ([`Answer`]).
//!
//! **Low speed.** The window widens beyond W until it has [`config::MIN_SAMPLES`], up to a set maximum; the lags say
//! what came of it. Two or three samples make a line, without acceleration; one edge alone tells no velocity, so
//! motion is first seen on the second edge, and an edge that is passed to and fro is at rest. While no edge comes the
//! newest velocity is held below what the silence allows, (1 + ½) d over its time (half a discrete is for displaced
//! edges), and after a set time it is zero.
//!
//! **Error** of the arithmetic, against the quadratic through the same samples in `f64` (test): at most 1.2e-4 d,
//! 6e-5 d/tick and 1e-5 d/tick² at the newest instant of a window of 15, 1.5e-4, 1.2e-4 and 4e-5 of one of 8. Most of
//! it is the rounding of a sample's place to 2⁻¹³ d. What noise of the samples comes to is in `docs/theory.md`.

pub mod config;
mod fit;
mod geometry;
mod ratio;
mod regular;
mod window;

pub use config::Config;

use self::fit::{Fit, wide};
use self::geometry::{GAIN_FRAC, Geometry, MIDDLE_FRAC};
use self::window::{Sample, Window};
use super::{Estimate, Evidence, Lags, Variances, shift_rounded};
use crate::capture::Observation;
use crate::edges::{EdgeSample, MAX_SPAN_TICKS, Span};
use crate::uncertainty::{EdgeNoise, PLACE_FRAC};
use crate::units::{Acceleration, Lag, Position, Variance, Velocity};

/// Steps of the time grid in a tick: 2¹.
const GRID_BITS: u32 = 1;
/// Steps of the time grid in a tick.
const STEPS: i32 = 1 << GRID_BITS;
/// Bits of a [`Span`] in a step.
const STEP_BITS: u32 = Span::FRAC_NBITS - GRID_BITS;
/// Fractional bits of times at which the fit is evaluated, ticks.
const TIME_FRAC: u32 = 24;

/// The instant that position and velocity are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// The samples' middle, where the fit is best.
    Centre,
    /// The sampling instant: no lag, more noise.
    Newest,
}

/// The window and what was found last.
// The window last: it is large, and the target reaches the first kilobyte by pairs.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Estimator {
    config: Config,
    /// Time from the last step of the grid to the sampling instant, in bits of a [`Span`].
    since_step: i32,
    motion: Motion,
    /// Count of the previous tick; wraps.
    count: i32,
    silence: Silence,
    dither: Dither,
    /// Velocity to be told until there are samples.
    primed: Option<i32>,
    window: Window,
}

/// What the last fit says.
#[derive(Clone, Copy, Debug, Default)]
struct Motion {
    /// Velocity at the sampling instant, Q12.20 d/tick.
    newest: i32,
    /// Q8.24 d/tick².
    acceleration: i32,
}

/// What a fit came to, at the samples' middle.
struct Found {
    /// Q.16 d from the count.
    place: i64,
    /// Q12.20 d/tick.
    velocity: i32,
    /// Q8.24 d/tick².
    acceleration: i32,
    /// Time from the middle to the sampling instant, ticks with [`TIME_FRAC`] fractional bits.
    behind: i32,
    /// It is a quadratic, not a line.
    is_curved: bool,
    /// Weights of the samples, added up.
    weight: u32,
    /// Variance of the velocity per d² of a sample of weight 1, [`GAIN_FRAC`].
    velocity_gain: u32,
    /// Variance of the acceleration, likewise.
    acceleration_gain: u32,
}

impl Found {
    /// Variance of the velocity at the sampling instant: at the middle it is independent of the acceleration's.
    #[inline]
    fn newest_gain(&self) -> u32 {
        const COARSE: u32 = TIME_FRAC - 8;
        let ticks = self.behind.wrapping_shr(COARSE).cast_unsigned();
        let square = ticks.wrapping_mul(ticks);
        let of_bend = u64::from(square)
            .wrapping_mul(u64::from(self.acceleration_gain))
            .wrapping_shr(16);
        self.velocity_gain.wrapping_add(of_bend as u32)
    }
}

impl Motion {
    const fn steady(velocity: i32) -> Self {
        Self {
            newest: velocity,
            acceleration: 0,
        }
    }
}

/// How long no edge has come.
#[derive(Clone, Copy, Debug, Default)]
struct Silence {
    /// Q24.8 ticks; stops at the maximum.
    ticks_q8: u32,
    /// Count when the last sample came; wraps.
    count: i32,
    /// The last sample came going backward.
    is_backward: bool,
}

impl Silence {
    #[inline]
    fn lengthen(&mut self, by: Span) {
        let ticks_q8 = by.to_bits().wrapping_shr(Span::FRAC_NBITS - 8);
        self.ticks_q8 = self.ticks_q8.saturating_add(ticks_q8);
    }
}

/// How many of the newest samples are one and the same boundary.
#[derive(Clone, Copy, Debug, Default)]
struct Dither {
    /// Place of the newest sample, 2⁻¹⁶ d modulo 2¹⁶ d.
    place: i32,
    samples: usize,
}

impl Estimator {
    /// An estimator without samples.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            window: Window::new(),
            since_step: 0,
            motion: Motion::steady(0),
            count: 0,
            silence: Silence {
                ticks_q8: 0,
                count: 0,
                is_backward: false,
            },
            dither: Dither {
                place: 0,
                samples: 0,
            },
            primed: None,
        }
    }

    /// Starts anew as after a long motion at `velocity`, which is told until there are samples. Outside the tick.
    pub fn prime(&mut self, velocity: Velocity) {
        let velocity = velocity.to_bits();
        *self = Self {
            motion: Motion::steady(velocity),
            primed: Some(velocity),
            ..Self::new(self.config)
        };
    }

    /// Takes what a tick has to tell.
    pub fn update(&mut self, evidence: &Evidence<'_>) -> Estimate {
        let Evidence {
            observation, edges, ..
        } = *evidence;
        let elapsed = edges.elapsed(observation);
        let way = (observation.count as i32).wrapping_sub(self.count);
        self.count = observation.count as i32;
        let is_gap = elapsed >= Span::from_bits(MAX_SPAN_TICKS << Span::FRAC_NBITS);
        if is_gap || way != observation.delta {
            self.start_over();
            return self.rest(observation);
        }
        let steps = self.advance(elapsed);
        let sample = match edges.sample(observation) {
            Some(sample) => Some(self.on_grid(observation, elapsed, &sample)),
            None => {
                self.silence.lengthen(elapsed);
                None
            }
        };
        let base = self.count.wrapping_shl(window::PLACE_FRAC);
        let regular = self.window.tick(&self.config, steps, base, sample);
        if self.is_at_rest() {
            return self.rest(observation);
        }
        self.primed = None;
        match regular {
            Some(step) => self.answer(observation, &self.regular(step), edges.noise()),
            None => self.answer_anywhere(observation, edges.noise()),
        }
    }

    /// Samples wherever they stand.
    #[inline(never)]
    fn answer_anywhere(&mut self, observation: &Observation<'_>, noise: &EdgeNoise) -> Estimate {
        self.answer(observation, &self.fit(), noise)
    }

    /// Goes on to this tick's sampling instant; steps of the grid since the previous one.
    #[inline]
    fn advance(&mut self, elapsed: Span) -> i32 {
        let since = self
            .since_step
            .wrapping_add(elapsed.to_bits().cast_signed());
        self.since_step = since & ((1 << STEP_BITS) - 1);
        since.wrapping_shr(STEP_BITS)
    }

    /// At the start, after a gap, or when the count ran away.
    #[cold]
    #[inline(never)]
    fn start_over(&mut self) {
        self.window.clear();
        self.since_step = 0;
        self.silence = Silence {
            count: self.count,
            ..Silence::default()
        };
        self.dither.samples = 0;
        self.motion = Motion::steady(self.primed.unwrap_or(0));
    }

    /// A sample at the nearest step of the grid, where the shaft was by the motion known.
    #[inline]
    fn on_grid(
        &mut self,
        observation: &Observation<'_>,
        elapsed: Span,
        sample: &EdgeSample,
    ) -> Sample {
        let place = sample.position.to_bits();
        let age = sample.age.to_bits().cast_signed();
        self.note_boundary(place, sample.edges);
        self.silence = Silence {
            ticks_q8: age.wrapping_shr(Span::FRAC_NBITS - 8).cast_unsigned(),
            count: self.count,
            is_backward: observation.delta < 0,
        };
        let time = self.since_step.wrapping_sub(age);
        // Not after the sampling instant: a sample at that very instant would come to stand on either side.
        let step = time
            .wrapping_add(1 << (STEP_BITS - 1))
            .wrapping_shr(STEP_BITS)
            .min(0);
        let rest = time.wrapping_sub(step.wrapping_shl(STEP_BITS));
        let velocity = if self.window.count() < config::MIN_SAMPLES && self.primed.is_none() {
            observation.delta.wrapping_shl(Velocity::FRAC_NBITS)
        } else {
            // In the middle between the sample and its step, counted from the previous tick.
            let after = elapsed
                .to_bits()
                .cast_signed()
                .wrapping_sub(age)
                .wrapping_sub(rest.wrapping_shr(1));
            let gained = wide(self.motion.acceleration, after).wrapping_shr(32) as i32;
            self.motion.newest.wrapping_add(gained)
        };
        let bridged = shift_rounded(wide(velocity, rest), 32);
        Sample {
            step: step.wrapping_add(self.config.window_steps.wrapping_shr(1)),
            edges: sample.edges,
            place: shift_rounded(
                place.wrapping_sub(bridged),
                Position::FRAC_NBITS - window::PLACE_FRAC,
            ) as i32,
        }
    }

    /// Counts how often in a row the same boundary was passed: half a discrete is more than hysteresis, less than
    /// the distance to the next one.
    #[inline]
    fn note_boundary(&mut self, place: i64, edges: u32) {
        // A place 2¹⁵ d away would be taken for the same: it is not one edge away.
        let place = place as i32;
        let apart = place.wrapping_sub(self.dither.place).unsigned_abs();
        let same = edges == 1 && apart < 1 << (Position::FRAC_NBITS - 1);
        let before = if same { self.dither.samples } else { 0 };
        self.dither = Dither {
            place,
            samples: before.wrapping_add(1),
        };
    }

    /// Fewer than two samples, all of them of one boundary, or a long silence.
    #[inline]
    fn is_at_rest(&self) -> bool {
        let samples = self.window.count();
        samples < 2
            || self.dither.samples >= samples
            || self.silence.ticks_q8 >= self.config.rest_ticks_q8
    }

    /// No velocity, or the one that was said beforehand; what is not known of it is what the silence allows.
    #[cold]
    #[inline(never)]
    fn rest(&mut self, observation: &Observation<'_>) -> Estimate {
        if self.silence.ticks_q8 >= self.config.rest_ticks_q8 {
            self.window.clear();
            self.primed = None;
        }
        let velocity = self.primed.unwrap_or(0);
        self.motion = Motion::steady(velocity);
        let most = self.most_in_silence().unwrap_or(i32::MAX).cast_unsigned();
        let square = u64::from(most.min(1 << 24)).wrapping_mul(u64::from(most.min(1 << 24)));
        // Uniform within ±most: a third of the square.
        let variance = Variance::from_bits(
            square
                .wrapping_shl(Variance::FRAC_NBITS - 2 * Velocity::FRAC_NBITS)
                .checked_div(3)
                .unwrap_or(0),
        );
        Estimate {
            position: observation.position(),
            velocity: Velocity::from_bits(velocity),
            acceleration: Acceleration::ZERO,
            lags: Lags::default(),
            variances: Variances {
                velocity: variance,
                acceleration: variance,
            },
        }
    }

    /// A full window of samples one a tick, the newest at `step` from the origin.
    #[inline]
    fn regular(&self, step: i32) -> Found {
        let regular = &self.config.regular;
        let ages = self.window.ages();
        let (velocity, acceleration) = regular.motion(ages);
        // Half a window less half a tick before the newest sample.
        let middle = step
            .wrapping_shl(1)
            .wrapping_sub(self.config.window_steps)
            .wrapping_add(STEPS)
            .wrapping_shl(TIME_FRAC - GRID_BITS - 1);
        Found {
            place: regular.place(ages, acceleration),
            velocity,
            acceleration,
            behind: self.now().wrapping_sub(middle),
            is_curved: true,
            weight: self.window.count() as u32,
            velocity_gain: regular.velocity_gain,
            acceleration_gain: regular.acceleration_gain,
        }
    }

    fn fit(&self) -> Found {
        let sums = self.window.sums();
        let geometry = Geometry::of(&sums);
        let now = self.now();
        let Motion {
            newest,
            acceleration,
        } = self.motion;
        let gained = wide(acceleration, now).wrapping_shr(24 + TIME_FRAC - 20) as i32;
        let fit = Fit::new(&sums, &geometry, newest.wrapping_sub(gained), acceleration);
        let middle = geometry
            .middle
            .wrapping_shl(TIME_FRAC - GRID_BITS - MIDDLE_FRAC);
        let gained = rounded::<{ 24 + TIME_FRAC - 20 }>(fit.acceleration, middle);
        let velocity = fit.velocity.saturating_add(gained);
        let way = trapezium(fit.velocity, velocity, middle);
        Found {
            place: fit.place.wrapping_add(way),
            velocity,
            acceleration: fit.acceleration,
            behind: now.wrapping_sub(middle),
            is_curved: geometry.by_spread.is_some(),
            weight: sums.weight.cast_unsigned(),
            velocity_gain: geometry.velocity_gain,
            acceleration_gain: geometry.acceleration_gain,
        }
    }

    /// The sampling instant from the window's origin.
    #[inline]
    const fn now(&self) -> i32 {
        self.config
            .window_steps
            .wrapping_shl(TIME_FRAC - GRID_BITS - 1)
            .wrapping_add(self.since_step.wrapping_shr(Span::FRAC_NBITS - TIME_FRAC))
    }

    #[inline(always)]
    fn answer(
        &mut self,
        observation: &Observation<'_>,
        found: &Found,
        noise: &EdgeNoise,
    ) -> Estimate {
        let behind = found.behind;
        let gained = rounded::<{ 24 + TIME_FRAC - 20 }>(found.acceleration, behind);
        let extrapolated = found.velocity.saturating_add(gained);
        let newest = self.within_silence(extrapolated);
        // The next sample is bridged to its step by how the shaft went, and it may have turned round.
        let most = self.most_in_silence().unwrap_or(i32::MAX);
        self.motion = Motion {
            newest: extrapolated.clamp(most.wrapping_neg(), most),
            acceleration: found.acceleration,
        };
        let lag = Lag::from_bits(behind.wrapping_shr(TIME_FRAC - Lag::FRAC_NBITS));
        let mut place = observation
            .count
            .wrapping_shl(Position::FRAC_NBITS)
            .wrapping_add(found.place);
        let (velocity, lag_x, lag_v, gain) = match self.config.answer {
            Answer::Centre => (found.velocity, lag, lag, found.velocity_gain),
            Answer::Newest => {
                place = place.wrapping_add(trapezium(found.velocity, newest, behind));
                // A line has no other velocity than that of its middle; what the silence allows is of now.
                let is_newest = found.is_curved || newest != extrapolated;
                let lag_v = if is_newest { Lag::ZERO } else { lag };
                (newest, Lag::ZERO, lag_v, found.newest_gain())
            }
        };
        let variances = self.variances(found.weight, gain, found.acceleration_gain, noise);
        Estimate {
            position: Position::from_bits(place),
            velocity: Velocity::from_bits(velocity),
            acceleration: Acceleration::from_bits(found.acceleration),
            lags: Lags {
                position: lag_x,
                velocity: lag_v,
                acceleration: lag,
            },
            variances,
        }
    }

    /// From the noise of a sample of weight 1: that of an edge, over the edges to each weight.
    #[inline]
    fn variances(
        &self,
        weight: u32,
        of_velocity: u32,
        of_acceleration: u32,
        noise: &EdgeNoise,
    ) -> Variances {
        // 24 significant bits, so that weights of 256 fit and many edges leave some.
        const SPARE_BITS: u32 = 8;
        let velocity = self.motion.newest;
        let of_edge = noise.of_edge(velocity);
        let lead = of_edge.leading_zeros() & 31;
        let of_sample = of_edge
            .wrapping_shl(lead)
            .wrapping_shr(SPARE_BITS)
            .wrapping_mul(weight)
            .checked_div(self.window.edges())
            .unwrap_or(0);
        let frac = const { PLACE_FRAC + GAIN_FRAC - SPARE_BITS - Variance::FRAC_NBITS };
        let of_samples = |gain: u32| {
            let product = u64::from(of_sample).wrapping_mul(u64::from(gain));
            Variance::from_bits(product.wrapping_shr(frac.wrapping_add(lead)))
        };
        Variances {
            velocity: of_samples(of_velocity).wrapping_add(noise.of_velocity(velocity)),
            acceleration: of_samples(of_acceleration).wrapping_add(noise.of_acceleration(velocity)),
        }
    }

    /// A velocity no larger than the silence since the last edge allows, one discrete and half a one for displaced edges,
    /// and not turned round: that would be seen on an edge.
    #[inline]
    fn within_silence(&self, velocity: i32) -> i32 {
        match self.most_in_silence() {
            None => velocity,
            Some(most) if self.silence.is_backward => velocity.clamp(most.wrapping_neg(), 0),
            Some(most) => velocity.clamp(0, most),
        }
    }

    /// The largest velocity after a silence of more than a tick, Q12.20 d/tick.
    #[inline]
    fn most_in_silence(&self) -> Option<i32> {
        const TICK_Q8: u32 = 1 << 8;
        let ticks = self.silence.ticks_q8;
        if ticks <= TICK_Q8 {
            return None;
        }
        let moved = self.count.wrapping_sub(self.silence.count).unsigned_abs();
        let halves = moved.min(MOST_MOVED).wrapping_mul(2).wrapping_add(3);
        // Halves of a d in Q.28 over Q.8 ticks: Q.20.
        let most = halves
            .wrapping_shl(Velocity::FRAC_NBITS + 8 - 1)
            .checked_div(ticks)
            .unwrap_or(0);
        Some(most.cast_signed())
    }
}

/// A way of more than this within a silence (of reversals and faults) need not be told apart: 15 halves in Q.27 fit
/// 31 bits.
const MOST_MOVED: u32 = 6;

/// `a`·`b`/2^`SHIFT`, to nearest, where it fits.
#[inline]
const fn rounded<const SHIFT: u32>(a: i32, b: i32) -> i32 {
    shift_rounded(wide(a, b), SHIFT) as i32
}

/// Way, Q.16 d, while the velocity goes evenly from one to the other (Q12.20 d/tick) in a time with [`TIME_FRAC`] bits.
#[inline]
const fn trapezium(from: i32, to: i32, time: i32) -> i64 {
    let mean = from.wrapping_shr(1).wrapping_add(to.wrapping_shr(1));
    wide(mean, time).wrapping_shr(20 + TIME_FRAC - Position::FRAC_NBITS)
}
