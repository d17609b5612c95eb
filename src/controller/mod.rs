//! From setpoint and estimate to a demand on the drive: PID with feedforward and corrective links.
//!
//! ```text
//! u = filtered( kp·e + ki·Σe + kd·Δe                PID on position, e = x_set − x
//!             + kv·(v_ref − v̂) + ka·(a_ref − â) )   the papers' corrective links (P2)
//!   + ff_v·v⁺ + ff_a·a⁺ + ff_j·j                    feedforward
//!   + learned shares of these three terms
//!   + friction(v⁺), at rest a push + bias
//!   + transfer                                      decays to zero, see below
//! ```
//!
//! The feedforward is for the instant at which the command arrives: v⁺ = v + τ·a + τ²·j/2 and a⁺ = a + τ·j, the setpoint
//! τ ahead ([`config::Gains::feedforward_lead`]), folded into the weights; [`turning`] adds what a change of the jerk within τ makes of it, and
//! [`learning`] what the drive shows it to be short of. [`filter`] holds what the feedback part passes through, [`friction`] the
//! feedforward against friction, [`rest`] what is done about a standing error; all cost next to nothing where they are off.
//!
//! An estimate holds for an instant `lag` ticks ago, so the links compare it with the setpoint of that
//! instant: v_ref = v − lag_v·a + ⟨lag_v²⟩·j/2, a_ref = a − lag_a·j, where ⟨lag_v²⟩ is the mean square age of
//! what the velocity is made of ([`Delay`](crate::estimator::Delay)). Since an estimator's lags are known
//! beforehand, [`Config`] folds them into the weights of a and j.
//!
//! At enable and at a change of parameters the law would jump; the jump is taken up by `transfer`,
//! which then decays geometrically, so the output stays continuous. Integration stops while the output
//! is limited in the direction in which the error would drive it further, and at rest where static friction holds the axis
//! ([`rest`]); the [`integral`] itself stays within ±1.

pub mod biquad;
pub mod config;
pub mod dead_time;
pub mod filter;
pub mod friction;
pub mod integral;
mod law;
pub mod learning;
pub mod params;
pub mod rest;
pub mod turning;
mod weights;

pub use config::Config;

use crate::estimator::Estimate;
use crate::output::ActiveLimits;
use crate::setpoint::Setpoint;
use crate::units::{Command, Position};

use crate::estimator::saturate;
use law::Tick;

/// Following error x_set − x in Q15.16 d; saturates at ±32 768 d.
pub type FollowingError = fixed::types::I16F16;

/// Controller state.
#[derive(Clone, Debug)]
pub struct Controller {
    config: Config,
    /// ki·Σe.
    integral: integral::State,
    /// Error of the previous tick, less the deadband.
    previous_error: i32,
    previous_following_error: i32,
    /// There was no previous tick.
    fresh: bool,
    /// Ticks for which the setpoint has been slow; counts no further than it matters.
    slow_ticks: u32,
    was_calm: bool,
    filter: filter::State,
    friction: friction::State,
    rest: rest::State,
    /// What of the last demand goes against friction or into the dead time, and what was learned, Q.30.
    withheld: i32,
    dead_time: dead_time::State,
    /// There is a jump to be taken up: `start_from` is set, or something is left in `transfer`.
    jumps: bool,
    /// What is left of the last jump of the law, Q.30; a jump across the range of a command needs 33 bits.
    transfer: i64,
    /// The next demand is to start from this output.
    start_from: Option<Command>,
    learning: learning::State,
}

/// What the controller asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Demand {
    /// Demand in fractions of full command, before the limits of the output.
    pub command: Command,
    /// Setpoint less measured position, d.
    pub following_error: FollowingError,
}

impl Controller {
    /// A controller that starts with its output at zero.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            integral: integral::State::new(),
            slow_ticks: u32::MAX,
            was_calm: true,
            filter: filter::State::new(),
            friction: friction::State::new(),
            rest: rest::State::new(),
            withheld: 0,
            dead_time: dead_time::State::new(),
            previous_error: 0,
            previous_following_error: 0,
            fresh: true,
            jumps: true,
            transfer: 0,
            start_from: Some(Command::ZERO),
            learning: learning::State::new(),
        }
    }

    /// Forgets everything but what it learned of the drive; the next demand starts from zero.
    pub fn reset(&mut self) {
        let learning = self.learning.clone();
        *self = Self::new(self.config);
        self.learning = learning;
    }

    /// Takes new parameters; the demand goes on from `output` without a step.
    pub fn reconfigure(&mut self, config: Config, output: Command) {
        if config.learning != self.config.learning {
            self.learning = learning::State::new();
        }
        self.config = config;
        // A new deadband must not look like a change of the error.
        self.previous_error = config.apply_deadband(self.previous_following_error);
        self.start_from = Some(output);
        self.jumps = true;
    }

    /// Takes what a tick shows beside what [`step`](Self::step) acts on: by how much the count changed, and what an observer is
    /// told of the command of the tick just past, with what came of it.
    #[inline]
    pub fn note(&mut self, delta: i32, command: Option<Command>, estimate: &Estimate) {
        self.rest.note(delta);
        if self.config.learning.is_on() {
            self.learning.note(&self.config.learning, command, estimate);
        }
    }

    /// By which shares the drive asks for more of the feedforward's terms of v, a and j than they give.
    #[must_use]
    pub fn learned(&self) -> [f64; 3] {
        self.learning.shares()
    }

    /// One tick: `position` is the measured position, `estimate` gives velocity and acceleration, and
    /// `active` are the limits that held the output of the previous tick.
    pub fn step(
        &mut self,
        setpoint: &Setpoint,
        position: Position,
        estimate: &Estimate,
        active: ActiveLimits,
    ) -> Demand {
        let behind = setpoint.position.to_bits().wrapping_sub(position.to_bits());
        let following_error = FollowingError::from_bits(saturate(behind));
        let error = self.config.apply_deadband(following_error.to_bits());
        if self.fresh {
            self.fresh = false;
            self.previous_error = error;
        }
        let change = error.saturating_sub(self.previous_error);
        self.previous_error = error;
        self.previous_following_error = following_error.to_bits();
        let tick = Tick {
            setpoint,
            estimate,
            active,
            error,
            change,
        };
        let command = match self.at_rest(setpoint, error) {
            None => self.law(tick, None),
            Some(verdict) => self.law_at_rest(setpoint, estimate, active, [error, change], verdict),
        };
        Demand {
            command: Command::from_bits(command),
            following_error,
        }
    }

    /// What of the last demand an observer of the nominal drive is not told: what goes against friction or falls into the
    /// drive's dead time, and moves nothing, and what the drive was found to need beyond the nominal feedforward.
    #[inline]
    #[must_use]
    pub const fn withheld(&self) -> Command {
        Command::from_bits(self.withheld)
    }
}
