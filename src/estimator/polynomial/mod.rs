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
//! edges), keeps its direction, and after a set time is zero.
//!
//! **Error** of the arithmetic, against the quadratic through the same samples in `f64` (test): at most 1.2e-4 d,
//! 6e-5 d/tick and 1e-5 d/tick² at the newest instant of a window of 15, 1.5e-4, 1.2e-4 and 4e-5 of one of 8. Most of
//! it is the rounding of a sample's place to 2⁻¹³ d. What noise of the samples comes to is in `docs/theory.md`.

pub mod config;
pub(crate) mod fit;
mod found;
pub(crate) mod geometry;
mod low_speed;
pub(crate) mod ratio;
mod regular;
mod spread;
pub(crate) mod window;

pub use config::Config;

use self::fit::wide;
use self::found::{Found, trapezium};
use self::low_speed::{Dither, Silence};
use self::spread::Spread;
use self::window::{Sample, Window};
use super::{Estimate, Evidence, Lags, Variances, shift_rounded};
use crate::capture::Observation;
use crate::edges::{EdgeSample, MAX_SPAN_TICKS, Span};
use crate::uncertainty::EdgeNoise;
use crate::units::{Acceleration, Lag, Position, Velocity};

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

impl Motion {
    const fn steady(velocity: i32) -> Self {
        Self {
            newest: velocity,
            acceleration: 0,
        }
    }
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
            silence: Silence::none(0),
            dither: Dither::NONE,
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
    #[inline(never)]
    pub fn update_into(&mut self, evidence: &Evidence<'_>, estimate: &mut Estimate) {
        let Evidence {
            observation,
            edges,
            ref sample,
            ..
        } = *evidence;
        let elapsed = edges.elapsed(observation);
        let way = (observation.count as i32).wrapping_sub(self.count);
        self.count = observation.count as i32;
        let is_gap = elapsed >= Span::from_bits(MAX_SPAN_TICKS << Span::FRAC_NBITS);
        if is_gap || way != observation.delta {
            self.start_over();
            self.rest(observation, estimate);
            return;
        }
        let steps = self.advance(elapsed);
        let base = self.count.wrapping_shl(window::PLACE_FRAC);
        let Some(sample) = sample else {
            self.silence.lengthen(elapsed);
            self.window.tick(&self.config, steps, base, None);
            self.answer_anywhere(observation, estimate);
            return;
        };
        let sample = self.on_grid(observation, elapsed, sample);
        match (self.window).tick(&self.config, steps, base, Some(sample)) {
            Some(step) if !self.is_at_rest() => {
                self.primed = None;
                let found = Found::regular(&self.config, &self.window, step, self.now());
                self.answer(observation, &found, estimate);
            }
            _ => self.answer_anywhere(observation, estimate),
        }
    }

    /// The same, given back.
    pub fn update(&mut self, evidence: &Evidence<'_>) -> Estimate {
        let mut estimate = Estimate::default();
        self.update_into(evidence, &mut estimate);
        estimate
    }

    /// How uncertain the newest estimate is, on edges of that noise. Outside the tick.
    #[must_use]
    pub fn variances(&self, noise: &EdgeNoise) -> Variances {
        if self.is_at_rest() {
            return self.silence.variances(self.count);
        }
        let spread = Spread::of(&self.config, &self.window, self.now());
        spread.variances(self.config.answer, self.motion.newest, noise)
    }

    /// Samples wherever they stand, if they tell a motion.
    #[inline(never)]
    fn answer_anywhere(&mut self, observation: &Observation<'_>, estimate: &mut Estimate) {
        if self.is_at_rest() {
            self.rest(observation, estimate);
            return;
        }
        self.primed = None;
        let found = Found::anywhere(&self.window, self.motion, self.now());
        self.answer(observation, &found, estimate);
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
        self.silence = Silence::none(self.count);
        self.dither = Dither::NONE;
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
        self.dither.note(place, sample.edges);
        self.silence = Silence::since(sample.age, self.count, observation.delta < 0);
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

    /// Fewer than two samples, all of them of one boundary, or a long silence.
    #[inline]
    fn is_at_rest(&self) -> bool {
        let samples = self.window.count();
        samples < 2
            || self.dither.samples() >= samples
            || self.silence.ticks_q8() >= self.config.rest_ticks_q8
    }

    /// No velocity, or the one that was said beforehand.
    #[cold]
    #[inline(never)]
    fn rest(&mut self, observation: &Observation<'_>, estimate: &mut Estimate) {
        if self.silence.ticks_q8() >= self.config.rest_ticks_q8 {
            self.window.clear();
            self.primed = None;
        }
        let velocity = self.primed.unwrap_or(0);
        self.motion = Motion::steady(velocity);
        *estimate = Estimate {
            position: observation.position(),
            velocity: Velocity::from_bits(velocity),
            acceleration: Acceleration::ZERO,
            lags: Lags::default(),
        };
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
    fn answer(&mut self, observation: &Observation<'_>, found: &Found, estimate: &mut Estimate) {
        let behind = found.behind;
        let extrapolated = found.newest();
        // The next sample is bridged to its step by how the shaft went, and it may have turned round.
        let (newest, bridging) = self.silence.hold(extrapolated, self.count);
        self.motion = Motion {
            newest: bridging,
            acceleration: found.acceleration,
        };
        let lag = Lag::from_bits(behind.wrapping_shr(TIME_FRAC - Lag::FRAC_NBITS));
        let mut place = observation
            .count
            .wrapping_shl(Position::FRAC_NBITS)
            .wrapping_add(found.place);
        let (velocity, lag_x, lag_v) = match self.config.answer {
            Answer::Centre => (found.velocity, lag, lag),
            Answer::Newest => {
                place = place.wrapping_add(trapezium(found.velocity, newest, behind));
                // A line has no other velocity than that of its middle; what the silence allows is of now.
                let is_newest = found.is_curved || newest != extrapolated;
                let lag_v = if is_newest { Lag::ZERO } else { lag };
                (newest, Lag::ZERO, lag_v)
            }
        };
        *estimate = Estimate {
            position: Position::from_bits(place),
            velocity: Velocity::from_bits(velocity),
            acceleration: Acceleration::from_bits(found.acceleration),
            lags: Lags {
                position: lag_x,
                velocity: lag_v,
                acceleration: lag,
            },
        };
    }
}
