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
//! rounds each, less than 5 000 in all: about a million operations in `f64` for the 16K20F3.
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
//! State is Q15.48, Q11.52 and Q7.56, relative to the newest count; gains are 30-bit mantissas. Against an `f64` oracle of the same
//! recursion (test) the outputs are right to 1e-5 d (half an LSB is 7.6e-6), 4e-6 d/tick and
//! 3e-6 d/tick².
mod classes;
mod config;
mod design;
mod gains;
mod linear;
mod motion;
mod params;
mod per_tick;
mod report;
mod sight;
mod supervisor;

pub use config::Config;
pub use gains::Gains;
pub use linear::Linear;
pub use params::ObserverParams;

use self::gains::Solved;
use self::motion::Motion;
pub(crate) use self::supervisor::Line;
use self::supervisor::Supervisor;
use super::{Estimate, Evidence, Variances};
use crate::uncertainty::EdgeNoise;
use crate::units::{Command, Velocity};

/// What the observer takes the motion to follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Model {
    /// The drive's response to its command.
    Drive,
    /// Its own acceleration, which changes at random: the command is not known or the drive's model is wrong.
    #[default]
    Kinematic,
}

/// A tick in a span of time.
const TICK: i32 = 1 << 28;

/// A tick that is late or early by no more, 6e-8 of itself, is on time.
const PUNCTUAL: u32 = 16;

/// The observer.
// What every tick needs comes first: the target reaches the first kilobyte by pairs.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Estimator {
    state: State,
    solved: Solved,
}

/// State of the observer.
#[derive(Clone, Debug)]
#[repr(C)]
struct State {
    motion: Motion,
    supervisor: Supervisor,
    /// Where the encoder's edges lie against the whole numbers: the map's correction at the newest sample, Q15.16 d.
    placed: i32,
    /// Ticks since the last sample or change of the count.
    silence: u32,
    /// Ticks since the last sample.
    unseen: u32,
    /// Class of the edges' density at the last sample.
    class: usize,
    /// The position is that of an edge: from the second edge on, velocity is seen.
    anchored: bool,
    restarts: u32,
    line: Line,
}

impl Estimator {
    /// An observer at rest; solves for its gains, outside the tick.
    #[must_use]
    pub fn new(config: Config) -> Self {
        Self::with_gains(config, &Gains::solve(&config))
    }

    /// An observer at rest with the gains that were [solved](Gains::solve) for `config`.
    #[must_use]
    pub const fn with_gains(config: Config, gains: &Gains) -> Self {
        Self {
            state: State::at_rest(),
            solved: Solved {
                config,
                gains: *gains,
            },
        }
    }

    /// Starts anew as after a long motion at `velocity`. Outside the tick.
    pub fn prime(&mut self, velocity: Velocity) {
        self.state = State::at_rest();
        if velocity != Velocity::ZERO {
            self.state.motion = Motion::steady(velocity.to_bits());
            self.state.silence = 0;
        }
    }

    /// The model that the newest estimate comes from.
    #[must_use]
    pub const fn model(&self) -> Model {
        self.state.supervisor.model()
    }

    /// How often the drive's model was given up because the motion did not follow it; stops at its maximum.
    #[must_use]
    pub const fn fallbacks(&self) -> u32 {
        self.state.supervisor.fallbacks()
    }

    /// How often the state was beyond all bounds and the observer began anew (a jump of the count); stops at
    /// its maximum.
    #[must_use]
    pub const fn restarts(&self) -> u32 {
        self.state.restarts
    }

    /// Takes what a tick has to tell.
    #[inline(never)]
    pub fn update_into(&mut self, evidence: &Evidence<'_>, estimate: &mut Estimate) {
        let Self { state, solved } = self;
        let config = &solved.config;
        let observation = evidence.observation;
        let jerk = state.jerk(config, evidence.command);
        let resting = state.silence >= config.supervision.rest_ticks;
        if !(resting && observation.delta == 0 && state.rests(config, jerk)) {
            state.motion.advance(jerk, observation.delta);
            if !evidence.edges.is_punctual(observation) {
                state.carry(evidence);
            }
        }
        let Some(sample) = &evidence.sample else {
            state.without_edge(solved, observation, estimate);
            return;
        };
        let class = state.see(solved, observation, sample);
        if state.motion.is_wild() {
            state.restart(observation.delta);
        }
        state.estimate(observation, class.lag, estimate);
    }

    /// The same, given back.
    pub fn update(&mut self, evidence: &Evidence<'_>) -> Estimate {
        let mut estimate = Estimate::default();
        self.update_into(evidence, &mut estimate);
        estimate
    }

    /// How uncertain the newest estimate is. Outside the tick.
    #[must_use]
    pub fn variances(&self, _: &EdgeNoise) -> Variances {
        self.state.variances(&self.solved)
    }
}

impl State {
    /// Where nothing has been seen yet.
    const fn at_rest() -> Self {
        Self {
            motion: Motion::steady(0),
            supervisor: Supervisor::new(),
            placed: 0,
            // Long since: an axis that was never seen to move stands.
            silence: u32::MAX,
            unseen: 0,
            class: 0,
            anchored: false,
            restarts: 0,
            line: Line::new(),
        }
    }

    /// Jerk by the model that runs.
    #[inline]
    fn jerk(&mut self, config: &Config, command: Option<Command>) -> i64 {
        let response = &config.response;
        let wanted = self
            .line
            .pass(command, response.delay)
            .map(|command| response.wanted(command));
        match wanted {
            Some(wanted) if self.supervisor.model() == Model::Drive => {
                self.drive_jerk(config, wanted)
            }
            _ => self.other_jerk(config, wanted),
        }
    }

    /// Jerk by the drive's model, disturbance included.
    #[inline]
    const fn drive_jerk(&self, config: &Config, wanted: i32) -> i64 {
        let motion = &self.motion;
        config
            .response
            .jerk(wanted, motion.velocity, motion.acceleration)
            .wrapping_add(motion.disturbance)
    }

    /// Jerk where the drive's model does not run, or its command is missing; it may be taken up or left by that.
    #[inline(never)]
    fn other_jerk(&mut self, config: &Config, wanted: Option<i32>) -> i64 {
        if self.supervisor.model() == Model::Kinematic {
            let Config {
                response,
                supervision,
                ..
            } = config;
            let resting = self.silence >= supervision.rest_ticks;
            self.supervisor
                .shadow(response, supervision, &mut self.motion, wanted, resting);
        }
        match (self.supervisor.model(), wanted) {
            (Model::Kinematic, _) => 0,
            (Model::Drive, Some(wanted)) => self.drive_jerk(config, wanted),
            (Model::Drive, None) => {
                self.supervisor.lose_command();
                0
            }
        }
    }

    /// Goes on by what the tick was longer or shorter than a tick.
    #[cold]
    #[inline(never)]
    fn carry(&mut self, evidence: &Evidence<'_>) {
        let elapsed = evidence.edges.elapsed(evidence.observation).to_bits();
        let late = elapsed.cast_signed().wrapping_sub(TICK);
        if late.unsigned_abs() > PUNCTUAL && elapsed != 0 {
            self.motion.carry(late);
        }
    }

    /// In silence: true if nothing speaks against rest, and then v and a are zero. The disturbance then slowly takes up
    /// whatever command does not move the axis; one that changes faster ends the rest before the first edge does.
    #[cold]
    #[inline(never)]
    fn rests(&mut self, config: &Config, jerk: i64) -> bool {
        if jerk.unsigned_abs() > config.supervision.release_jerk.unsigned_abs() {
            self.silence = 0;
            return false;
        }
        let motion = &mut self.motion;
        motion.disturbance = motion
            .disturbance
            .wrapping_sub(jerk.wrapping_shr(REST_SHIFT));
        motion.velocity = 0;
        motion.acceleration = 0;
        true
    }

    /// From the count's middle, at the speed at which it moves.
    #[cold]
    #[inline(never)]
    fn restart(&mut self, delta: i32) {
        self.restarts = self.restarts.saturating_add(1);
        self.motion = Motion::steady(delta.wrapping_shl(Velocity::FRAC_NBITS));
        self.supervisor.doubt();
        self.placed = 0;
        self.silence = 0;
        self.unseen = 0;
        self.anchored = false;
    }
}

/// While at rest the disturbance takes up 2⁻ⁿ of the jerk in a tick.
const REST_SHIFT: u32 = 5;
