//! Local polynomial: the least-squares quadratic over the last W ticks of edge samples, at their true times.
//!
//! A sample is a place and the time at which the shaft was there ([`crate::edges`]), so neither the rounding to
//! whole counts nor jitter of the sampling instant enters. Times are held on a grid of half a tick; what is left of a
//! sample's time, at most a quarter of a tick, is bridged with the velocity and acceleration found last. Where the
//! samples stand one a tick, as they do above 1 d/tick, the fit is a weighted sum ([`weights`]); elsewhere the normal
//! equations are solved, in exact integers ([`fit`]).
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
//! **Error** of the arithmetic, against the fit of the same samples in `f64` (test): position 2⁻¹⁴ d, velocity 4 and
//! acceleration 8 LSB, for windows from 8 ticks on. What noise of the samples comes to is in `docs/theory.md`.

pub mod config;
mod fit;
mod geometry;
mod ratio;
mod weights;
mod window;

pub use config::Config;

use self::fit::{Fit, wide};
use self::geometry::{GAIN_FRAC, Geometry, MIDDLE_FRAC};
use self::window::{Sample, Window};
use super::{Estimate, Evidence, Lags, Variances, saturate, shift_rounded};
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
#[derive(Clone, Debug)]
pub struct Estimator {
    config: Config,
    window: Window,
    /// Time from the last step of the grid to the sampling instant, in bits of a [`Span`].
    since_step: i32,
    motion: Motion,
    /// Count of the previous tick; wraps.
    count: i32,
    silence: Silence,
    dither: Dither,
    /// Velocity to be told until there are samples.
    primed: Option<i32>,
}

/// What the last fit says.
#[derive(Clone, Copy, Debug, Default)]
struct Motion {
    /// Velocity at the sampling instant, Q12.20 d/tick.
    newest: i32,
    /// Q8.24 d/tick².
    acceleration: i32,
}

/// What a fit came to; times from the window's origin with [`TIME_FRAC`] fractional bits.
struct Found {
    fit: Fit,
    /// The fit's origin.
    origin: i32,
    /// Mean time of the samples.
    middle: i32,
    /// It is a quadratic, not a line.
    is_curved: bool,
    /// Variances per d² of a sample.
    velocity_gain: u32,
    acceleration_gain: u32,
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
        let sample = edges
            .sample(observation)
            .map(|sample| self.on_grid(observation, elapsed, &sample));
        let base = self.count.wrapping_shl(window::PLACE_FRAC);
        self.window.tick(&self.config, steps, base, sample);
        if self.is_at_rest() {
            return self.rest(observation);
        }
        self.primed = None;
        let found = match self.window.regular(&self.config) {
            Some(step) => self.weigh(step),
            None => self.fit(),
        };
        self.answer(observation, &found, edges.noise())
    }

    /// Goes on to this tick's sampling instant; steps of the grid since the previous one.
    #[inline]
    fn advance(&mut self, elapsed: Span) -> i32 {
        let since = self
            .since_step
            .wrapping_add(elapsed.to_bits().cast_signed());
        self.since_step = since & ((1 << STEP_BITS) - 1);
        let passed = elapsed.to_bits().wrapping_shr(Span::FRAC_NBITS - 8);
        self.silence.ticks_q8 = self.silence.ticks_q8.saturating_add(passed);
        since.wrapping_shr(STEP_BITS)
    }

    /// At the start, after a gap, or when the count ran away.
    #[cold]
    #[inline(never)]
    fn start_over(&mut self) {
        self.window.clear();
        self.since_step = 0;
        self.silence = Silence {
            ticks_q8: 0,
            count: self.count,
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
        };
        let time = self.since_step.wrapping_sub(age);
        let step = time
            .wrapping_add(1 << (STEP_BITS - 1))
            .wrapping_shr(STEP_BITS);
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
        self.dither = Dither {
            place,
            samples: if same {
                self.dither.samples.saturating_add(1)
            } else {
                1
            },
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
        let most = self.within_silence(i32::MAX).cast_unsigned();
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
    fn weigh(&self, step: i32) -> Found {
        let weights = &self.config.weights;
        let count = self.window.count();
        let [velocity, acceleration] = weights.weigh(self.window.places(), count);
        let newest = step.wrapping_shl(TIME_FRAC - GRID_BITS);
        let half = self.config.window_steps.wrapping_sub(STEPS).wrapping_shr(1);
        let middle = newest.wrapping_sub(half.wrapping_shl(TIME_FRAC - GRID_BITS));
        let fit = Fit {
            place: self.newest_place(velocity, acceleration),
            velocity,
            acceleration,
        };
        let asked = self.asked(middle).wrapping_sub(newest);
        let [constant, first, second] = weights.velocity_gains;
        let slope = first.wrapping_add(wide(second, asked).wrapping_shr(TIME_FRAC) as i32);
        let gain = constant.wrapping_add(wide(slope, asked).wrapping_shr(TIME_FRAC) as i32);
        Found {
            fit,
            origin: newest,
            middle,
            is_curved: true,
            velocity_gain: gain.cast_unsigned(),
            acceleration_gain: weights.acceleration_gain,
        }
    }

    /// The fit's place at the newest sample of a regular window, Q.16 d from the base: the mean place and what lies between.
    #[inline]
    fn newest_place(&self, velocity: i32, acceleration: i32) -> i64 {
        let weights = &self.config.weights;
        // The mean of 2¹⁷ d has 31 bits; its sum is taken apart so that 32-bit products do.
        let total = self.window.total();
        let high =
            wide((total.wrapping_shr(8)) as i32, 1).wrapping_mul(i64::from(weights.per_sample));
        let mean = shift_rounded(high, 32 - 8 - 2);
        let half = self.config.window_steps.wrapping_sub(STEPS).wrapping_shr(1);
        let way = wide(velocity, half).wrapping_shr(20 - 16 + GRID_BITS);
        let bent = wide(acceleration, weights.mean_square).wrapping_shr(24);
        mean.wrapping_add(way).wrapping_sub(bent)
    }

    /// Samples wherever they stand.
    #[inline(never)]
    fn fit(&self) -> Found {
        let sums = self.window.sums();
        let to_time = |q8: i32| q8.wrapping_shl(TIME_FRAC - GRID_BITS - MIDDLE_FRAC);
        let asked = match self.config.answer {
            Answer::Centre => None,
            Answer::Newest => Some(self.now().wrapping_shr(TIME_FRAC - GRID_BITS - MIDDLE_FRAC)),
        };
        let geometry = Geometry::of(&sums, asked);
        let Motion {
            newest,
            acceleration,
        } = self.motion;
        let gained = wide(acceleration, self.now()).wrapping_shr(24 + TIME_FRAC - 20) as i32;
        Found {
            fit: Fit::new(&sums, &geometry, newest.wrapping_sub(gained), acceleration),
            origin: 0,
            middle: to_time(geometry.middle),
            is_curved: geometry.by_spread.is_some(),
            velocity_gain: geometry.velocity_gain,
            acceleration_gain: geometry.acceleration_gain,
        }
    }

    /// The sampling instant from the window's origin.
    #[inline]
    const fn now(&self) -> i32 {
        self.config
            .window_steps
            .wrapping_shr(1)
            .wrapping_shl(TIME_FRAC - GRID_BITS)
            .wrapping_add(self.since_step.wrapping_shr(Span::FRAC_NBITS - TIME_FRAC))
    }

    /// The instant asked for, from the window's origin.
    #[inline]
    const fn asked(&self, middle: i32) -> i32 {
        match self.config.answer {
            Answer::Centre => middle,
            Answer::Newest => self.now(),
        }
    }

    #[inline]
    fn answer(
        &mut self,
        observation: &Observation<'_>,
        found: &Found,
        noise: &EdgeNoise,
    ) -> Estimate {
        let fit = &found.fit;
        let now = self.now();
        let behind = to_lag(now.wrapping_sub(found.middle));
        let at = self.asked(found.middle).wrapping_sub(found.origin);
        let (lag_x, lag_v) = match self.config.answer {
            Answer::Centre => (behind, behind),
            Answer::Newest if found.is_curved => (Lag::ZERO, Lag::ZERO),
            // A line has no other velocity than that of its middle.
            Answer::Newest => (Lag::ZERO, behind),
        };
        let newest = fit.velocity_at(now.wrapping_sub(found.origin));
        self.motion = Motion {
            newest: self.within_silence(newest),
            acceleration: fit.acceleration,
        };
        let velocity = match self.config.answer {
            Answer::Centre => fit.velocity_at(at),
            Answer::Newest => self.motion.newest,
        };
        let base = observation.count.wrapping_shl(Position::FRAC_NBITS);
        Estimate {
            position: Position::from_bits(base.wrapping_add(fit.place_at(at))),
            velocity: Velocity::from_bits(velocity),
            acceleration: Acceleration::from_bits(fit.acceleration),
            lags: Lags {
                position: lag_x,
                velocity: lag_v,
                acceleration: behind,
            },
            variances: self.variances(found, noise),
        }
    }

    /// From the noise of a sample, which is that of an edge over the mean number of edges.
    #[inline]
    fn variances(&self, found: &Found, noise: &EdgeNoise) -> Variances {
        let velocity = self.motion.newest;
        let of_sample = noise
            .of_edge(velocity)
            .saturating_mul(self.window.count() as u32)
            .checked_div(self.window.edges())
            .unwrap_or(u32::MAX);
        let of_samples = |gain: u32| {
            let product = u64::from(of_sample).wrapping_mul(u64::from(gain));
            Variance::from_bits(product.wrapping_shr(PLACE_FRAC + GAIN_FRAC - Variance::FRAC_NBITS))
        };
        Variances {
            velocity: of_samples(found.velocity_gain).saturating_add(noise.of_velocity(velocity)),
            acceleration: of_samples(found.acceleration_gain)
                .saturating_add(noise.of_acceleration(velocity)),
        }
    }

    /// A velocity no larger than the silence since the last edge allows: one discrete, and half a one for displaced
    /// edges.
    #[inline]
    fn within_silence(&self, velocity: i32) -> i32 {
        const TICK_Q8: u32 = 1 << 8;
        let ticks = self.silence.ticks_q8;
        if ticks <= TICK_Q8 {
            return velocity;
        }
        let moved = self.count.wrapping_sub(self.silence.count).unsigned_abs();
        let halves = moved.min(MOST_MOVED).wrapping_mul(2).wrapping_add(3);
        // Halves of a d in Q.28 over Q.8 ticks: Q.20.
        let most = halves
            .wrapping_shl(Velocity::FRAC_NBITS + 8 - 1)
            .checked_div(ticks)
            .unwrap_or(0)
            .cast_signed();
        velocity.clamp(most.wrapping_neg(), most)
    }
}

/// A way of more than this within a silence (of reversals and faults) need not be told apart: 15 halves in Q.27 fit
/// 31 bits.
const MOST_MOVED: u32 = 6;

/// A time with [`TIME_FRAC`] fractional bits.
const fn to_lag(time: i32) -> Lag {
    Lag::from_bits(time.wrapping_shr(TIME_FRAC - Lag::FRAC_NBITS))
}

impl Fit {
    /// Velocity at a time from the fit's origin, Q12.20 d/tick.
    #[inline]
    fn velocity_at(&self, time: i32) -> i32 {
        let gained = shift_rounded(wide(self.acceleration, time), 24 + TIME_FRAC - 20);
        saturate(i64::from(self.velocity).wrapping_add(gained))
    }

    /// Place at a time from the fit's origin, Q.16 d from the base.
    #[inline]
    fn place_at(&self, time: i32) -> i64 {
        let half_gained = wide(self.acceleration, time).wrapping_shr(24 + TIME_FRAC - 20 + 1);
        let mean = saturate(i64::from(self.velocity).wrapping_add(half_gained));
        let way = shift_rounded(wide(mean, time), 20 + TIME_FRAC - 16);
        self.place.wrapping_add(way)
    }
}
