//! Kalman-type observer of position, velocity, acceleration and a disturbance, from edge times and the
//! drive's command.
//!
//! **Models.** Over a tick the jerk j is constant: x += v + a/2 + j/6, v += a + j/2, a += j. By the *drive's* model,
//! v″ + 2ζω·v′ + ω²·v = ω²·(G·u + d), j = k₁·(G·u − v) − k₂·a + δ with k₁, k₂ from the matrix exponential, so that
//! a is exact at each tick for a command that stays; the arc between is off by ω²·j/12 in v. u is delayed by whole
//! ticks; δ = k₁·d is the disturbance as a jerk, a random walk. Without a command (a replay, the drive off), or
//! where the motion does not follow it, the *kinematic* model runs: j = 0, a is a random walk.
//!
//! **Measurement.** The tick's edges say that the shaft was at `place` `age` ticks ago: the innovation is
//! place − (x − v·τ + a·(τ² + s)/2), where s is the variance of the edges' ages, (1 − 1/n²)/12: their mean place is
//! not that at their mean time. Its variance is (σ_edge² + n²·σ_t²)/n for n edges.
//!
//! **Gains** are those of the steady state, from Riccati equations iterated at configuration for 18 densities
//! of edges, one in 128 ticks to 1 024 in a tick, and two models; a tick takes those of its octave. Bounded by 400
//! rounds each, less than 5 000 in all: some 3 million operations in `f64`.
//!
//! **Without an edge** the state is predicted, but the position has to stay in its discrete (± ¼ d, moved by what
//! the encoder map last said): what lies outside is an innovation. After the set silence v and a are exactly
//! zero, until an edge comes or the command changes by more than the set feed. The first edge after that gives
//! the position alone; velocity is seen on the second.
//!
//! **Lag** is zero with the drive's model as far as it is right. With the kinematic one it is zero for position
//! and velocity and K_v/K_a − ½ ticks for the acceleration, which each estimate states.
//!
//! **Uncertainty** is that of the edges' noise through the filter (a Lyapunov equation, with the gains held), and
//! the map's residual of long wave on top: v·slope and v²·curvature. A wrong drive model is not in it: off its
//! nominal figures the error is several times the stated 1σ while the axis accelerates.
//!
//! State is Q11.52 and Q7.56, relative to the newest count; gains are 30-bit mantissas. Against an `f64` oracle of the same
//! recursion (test) the outputs are right to 1e-5 d (half an LSB is 7.6e-6), 4e-6 d/tick and
//! 3e-6 d/tick².
mod config;
mod design;
mod motion;
mod params;
mod supervisor;

pub use config::Config;
pub use params::ObserverParams;

use self::config::{Class, MAX_UNSEEN, ONE_A_TICK};
use self::motion::{COARSE_FRAC, INNOVATION_FRAC, Motion, high};
use self::supervisor::{Line, Supervisor};
use super::{Estimate, Evidence, Lags, Variances};
use crate::capture::Observation;
use crate::edges::EdgeSample;
use crate::units::{Acceleration, Lag, Position, Variance, Velocity};

/// What the observer takes the motion to follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Model {
    /// The drive's response to its command.
    Drive,
    /// Its own acceleration, which changes at random: the command is not known or the drive's model is wrong.
    #[default]
    Kinematic,
}

/// How far beyond its discrete a position may lie unpunished, d: what the places of the edges differ by.
const TOLERANCE: i64 = ONE / 4;
/// Octave of the gains at the end of a discrete: those of an edge in four ticks end a motion within some ten
/// ticks, and do not take a place that is a little off for a motion.
const HOLD_OCTAVE: i32 = ONE_A_TICK - 2;
/// One d as an innovation.
const ONE: i64 = 1 << INNOVATION_FRAC;
/// A tick in a span of time.
const TICK: i32 = 1 << 28;

/// Counts by which the motion of a tick may differ from the last velocity; the position's format has some more.
const MOST_SLIP: u32 = 1000;
/// A tick that is late or early by no more, 6e-8 of itself, is on time.
const PUNCTUAL: u32 = 16;

/// State of the observer.
#[derive(Clone, Debug)]
pub struct Estimator {
    config: Config,
    motion: Motion,
    line: Line,
    supervisor: Supervisor,
    /// Where the encoder's edges lie against the whole numbers: the map's correction at the newest sample,
    /// d with [`INNOVATION_FRAC`] bits.
    placed: i64,
    /// Ticks since the last sample or change of the count.
    silence: u32,
    /// Ticks since the last sample.
    unseen: u32,
    /// The position is that of an edge: from the second edge on, velocity is seen.
    anchored: bool,
    /// Octave of the edges' density, as [`Config::class`] has it.
    octave: i32,
    restarts: u32,
}

impl Estimator {
    /// An observer at rest.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            motion: Motion::steady(0),
            line: Line::new(),
            supervisor: Supervisor::new(),
            placed: 0,
            // Long since: an axis that was never seen to move stands.
            silence: u32::MAX,
            unseen: 0,
            anchored: false,
            octave: 0,
            restarts: 0,
            config,
        }
    }

    /// Starts anew as after a long motion at `velocity`. Outside the tick.
    pub fn prime(&mut self, velocity: Velocity) {
        *self = Self::new(self.config);
        if velocity != Velocity::ZERO {
            self.motion = Motion::steady(velocity.to_bits());
            self.silence = 0;
        }
    }

    /// The model that the newest estimate comes from.
    #[must_use]
    pub const fn model(&self) -> Model {
        self.supervisor.model()
    }

    /// How often the drive's model was given up because the motion did not follow it; stops at its maximum.
    #[must_use]
    pub const fn fallbacks(&self) -> u32 {
        self.supervisor.fallbacks()
    }

    /// How often the state was beyond all bounds and the observer began anew (a jump of the count); stops at
    /// its maximum.
    #[must_use]
    pub const fn restarts(&self) -> u32 {
        self.restarts
    }

    /// Takes what a tick has to tell.
    // Not inlined: beside it the other estimators of the enum would save its registers too.
    #[inline(never)]
    pub fn update(&mut self, evidence: &Evidence<'_>) -> Estimate {
        let observation = evidence.observation;
        let wanted = self.wanted(evidence);
        let resting = self.silence >= self.config.supervision.rest_ticks;
        if self.supervisor.model() == Model::Kinematic {
            self.shadow(wanted, resting);
        }
        let jerk = match self.supervisor.model() {
            Model::Drive => self.drive_jerk(wanted),
            Model::Kinematic => 0,
        };
        if resting && observation.delta == 0 && self.rests(jerk) {
            self.motion.velocity = 0;
            self.motion.acceleration = 0;
        } else {
            let slip = high(self.motion.velocity)
                .wrapping_shr(Velocity::FRAC_NBITS)
                .wrapping_sub(observation.delta);
            if slip.unsigned_abs() > MOST_SLIP {
                self.restart(observation);
            }
            self.motion.advance(jerk, observation.delta);
            let elapsed = evidence.edges.elapsed(observation).to_bits().cast_signed();
            let late = elapsed.wrapping_sub(TICK);
            if late.unsigned_abs() > PUNCTUAL && elapsed != 0 {
                self.motion.carry(late);
            }
        }
        match evidence.edges.sample(observation) {
            Some(sample) => self.see(observation, &sample),
            None => self.hold(observation),
        }
        if self.motion.is_wild() {
            self.restart(observation);
        }
        self.estimate(observation)
    }

    /// The velocity that the drive aims at in this tick, Q11.20, if its command is known.
    #[inline]
    fn wanted(&mut self, evidence: &Evidence<'_>) -> Option<i64> {
        let response = &self.config.response;
        let command = self.line.pass(evidence.command, response.delay)?;
        Some(response.wanted(command))
    }

    /// Jerk by the drive's model, disturbance included; without a command the model is left.
    #[inline]
    fn drive_jerk(&mut self, wanted: Option<i64>) -> i64 {
        let Some(wanted) = wanted else {
            self.supervisor.lose_command();
            return 0;
        };
        let motion = &self.motion;
        self.config
            .response
            .jerk(wanted, motion.velocity, motion.acceleration)
            .wrapping_add(motion.disturbance)
    }

    /// In silence: true if nothing speaks against rest. The disturbance then slowly takes up whatever command
    /// does not move the axis; one that changes faster ends the rest before the first edge does.
    #[cold]
    fn rests(&mut self, jerk: i64) -> bool {
        if jerk.unsigned_abs() > self.config.supervision.release_jerk.unsigned_abs() {
            self.silence = 0;
            return false;
        }
        self.motion.disturbance = self
            .motion
            .disturbance
            .wrapping_sub(jerk.wrapping_shr(REST_SHIFT));
        true
    }

    /// Whether the drive's model would do again.
    #[inline(never)]
    fn shadow(&mut self, wanted: Option<i64>, resting: bool) {
        let Config {
            response,
            supervision,
            ..
        } = &self.config;
        self.supervisor
            .shadow(response, supervision, &mut self.motion, wanted, resting);
    }

    /// Corrects by a sample of the edges.
    #[inline]
    fn see(&mut self, observation: &Observation<'_>, sample: &EdgeSample) {
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
    fn hold(&mut self, observation: &Observation<'_>) {
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
    }

    /// From the count's middle, at the speed at which it moves.
    #[cold]
    fn restart(&mut self, observation: &Observation<'_>) {
        self.restarts = self.restarts.saturating_add(1);
        self.motion = Motion::steady(observation.delta.wrapping_shl(Velocity::FRAC_NBITS));
        self.supervisor.doubt();
        self.placed = 0;
        self.silence = 0;
        self.unseen = 0;
        self.anchored = false;
    }

    #[inline]
    fn estimate(&self, observation: &Observation<'_>) -> Estimate {
        let base = observation.count.wrapping_shl(Position::FRAC_NBITS);
        let drive = self.supervisor.model() == Model::Drive;
        let velocity = self.motion.velocity_q20();
        let class = self.config.class(drive, self.octave);
        let resting = self.silence >= self.config.supervision.rest_ticks;
        let variances = if resting {
            self.config.rest_variances
        } else {
            self.with_long_wave(class, velocity)
        };
        let at_rest = resting && self.motion.velocity == 0;
        Estimate {
            position: Position::from_bits(base.wrapping_add(self.motion.position_q16())),
            velocity: Velocity::from_bits(velocity),
            acceleration: Acceleration::from_bits(self.motion.acceleration_q24()),
            lags: Lags {
                position: Lag::ZERO,
                velocity: Lag::ZERO,
                acceleration: if at_rest { Lag::ZERO } else { class.lag },
            },
            variances,
        }
    }

    /// The variances of a class, and what the map's residual of long wave adds at a velocity in Q11.20.
    #[inline]
    fn with_long_wave(&self, class: &Class, velocity: i32) -> Variances {
        let speed = velocity.unsigned_abs();
        let slope = u64::from(self.config.wave_slope);
        // Q20 · Q24 for 24, and times Q32 once more.
        let of_velocity = u64::from(speed).wrapping_mul(slope).wrapping_shr(20) as u32;
        let wave = u64::from(speed).wrapping_mul(u64::from(self.config.wave_number));
        let wave = wave.wrapping_shr(20) as u32;
        let of_acceleration = u64::from(of_velocity)
            .wrapping_mul(u64::from(wave))
            .wrapping_shr(32) as u32;
        Variances {
            velocity: added(class.variances.velocity, of_velocity),
            acceleration: added(class.variances.acceleration, of_acceleration),
        }
    }
}

/// While at rest the disturbance takes up 2⁻ⁿ of the jerk in a tick.
const REST_SHIFT: u32 = 5;

/// Largest deviation by the long wave, 128 in Q8.24: its square and the variance of a class fit their format.
const MOST_DEVIATION: u32 = 1 << 31;

/// `variance` and the square of a deviation in Q8.24.
#[inline]
fn added(variance: Variance, deviation: u32) -> Variance {
    let deviation = if deviation > MOST_DEVIATION {
        MOST_DEVIATION
    } else {
        deviation
    };
    let square = u64::from(deviation).wrapping_mul(u64::from(deviation));
    Variance::from_bits(variance.to_bits().wrapping_add(square))
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
