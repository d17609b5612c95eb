//! From setpoint and estimate to a demand on the drive: PID with feedforward and corrective links.
//!
//! ```text
//! u = filtered( kp·e + ki·Σe + kd·Δe                PID on position, e = x_set − x
//!             + kv·(v_ref − v̂) + ka·(a_ref − â) )   the papers' corrective links (P2)
//!   + ff_v·v⁺ + ff_a·a⁺ + ff_j·j                    feedforward
//!   + friction(v⁺) + bias
//!   + transfer                                      decays to zero, see below
//! ```
//!
//! The feedforward is for the instant at which the command arrives: v⁺ = v + τ·a + τ²·j/2 and a⁺ = a + τ·j, the setpoint
//! τ ahead ([`config::Gains::feedforward_lead`]), folded into the weights. [`filter`] holds what the feedback part passes
//! through, [`friction`] the feedforward against friction; both cost next to nothing where they are off.
//!
//! An estimate holds for an instant `lag` ticks ago, so the links compare it with the setpoint of that
//! instant: v_ref = v − lag_v·a + ⟨lag_v²⟩·j/2, a_ref = a − lag_a·j, where ⟨lag_v²⟩ is the mean square age of
//! what the velocity is made of ([`Delay`](crate::estimator::Delay)). Since an estimator's lags are known
//! beforehand, [`Config`] folds them into the weights of a and j.
//!
//! At enable and at a change of parameters the law would jump; the jump is taken up by `transfer`,
//! which then decays geometrically, so the output stays continuous. Integration stops while the output
//! is limited in the direction in which the error would drive it further, and at rest where static friction holds the axis
//! ([`integral`], [`friction`]); the integral itself stays within ±1, and as much again at sixteen times the speed from which on it goes
//! with the speed.

pub mod biquad;
pub mod config;
pub mod dead_time;
pub mod filter;
pub mod friction;
pub mod integral;
pub mod params;

pub use config::Config;

use crate::estimator::Estimate;
use crate::output::ActiveLimits;
use crate::setpoint::Setpoint;
use crate::units::{Command, Position};

use crate::estimator::saturate;
use integral::Verdict;

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
    filter: filter::State,
    friction: friction::State,
    dead_time: dead_time::State,
    /// What is left of the last jump of the law, Q.30; a jump across the range of a command needs 33 bits.
    transfer: i64,
    /// The next demand is to start from this output.
    start_from: Option<Command>,
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
            filter: filter::State::new(),
            friction: friction::State::new(),
            dead_time: dead_time::State::new(),
            previous_error: 0,
            previous_following_error: 0,
            fresh: true,
            transfer: 0,
            start_from: Some(Command::ZERO),
        }
    }

    /// Forgets everything; the next demand starts from zero.
    pub const fn reset(&mut self) {
        *self = Self::new(self.config);
    }

    /// Takes new parameters; the demand goes on from `output` without a step.
    pub const fn reconfigure(&mut self, config: Config, output: Command) {
        self.config = config;
        // A new deadband must not look like a change of the error.
        self.previous_error = config.apply_deadband(self.previous_following_error);
        self.start_from = Some(output);
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
        let signals = [
            error,
            error.saturating_sub(self.previous_error),
            estimate.velocity.to_bits(),
            estimate.acceleration.to_bits(),
            setpoint.velocity.to_bits(),
            setpoint.acceleration.to_bits(),
            setpoint.jerk.to_bits(),
        ];
        self.previous_error = error;
        self.previous_following_error = following_error.to_bits();
        let calm = self.is_calm(error, setpoint);
        let set = if calm {
            &self.config.calm
        } else {
            &self.config.moving
        };
        let mut law = set.weigh(&signals);
        let resting = is_at_rest(setpoint);
        let (config, speed) = (&self.config.integral, setpoint.velocity.to_bits());
        let verdict = self.integral.judge(config, error, resting);
        let is_lifted = resting && self.config.friction.lifts() && verdict != Verdict::Far;
        if !is_lifted && verdict != Verdict::Within {
            let increment = i64::from(error).wrapping_mul(i64::from(set.integral_gain));
            // Not further into a limit of the output.
            if !(increment > 0 && active.high || increment < 0 && active.low) {
                self.integral.add(increment);
            }
        }
        if config.learns() && setpoint.acceleration.to_bits() | setpoint.jerk.to_bits() == 0 {
            self.integral.learn(config, speed);
        }
        law = law.wrapping_add(self.integral.value(config, speed));
        if self.config.filter.is_on() {
            law = self.filtered(law, setpoint);
        }
        if self.config.friction.is_on() {
            let level = if is_lifted {
                let standing = (verdict == Verdict::Near).then_some(error);
                self.friction.lift(&self.config.friction, standing)
            } else {
                self.friction.step(&self.config.friction, setpoint)
            };
            law = law.wrapping_add(i64::from(level));
        }
        if self.config.dead_time.is_on() {
            let friction = self.friction.level().to_bits();
            law = self
                .dead_time
                .step(&self.config.dead_time, law, friction, resting);
        }
        let command = self.without_jump(saturate(law));
        Demand {
            command: Command::from_bits(command),
            following_error,
        }
    }

    /// What of the last demand moves nothing: what goes against friction, and what falls into the drive's dead time.
    #[inline]
    #[must_use]
    pub const fn friction(&self) -> Command {
        let lost = saturate(self.dead_time.lost());
        Command::from_bits(self.friction.level().to_bits().saturating_add(lost))
    }

    /// The feedback part through the filters, and what passes by them.
    #[inline(never)]
    fn filtered(&mut self, feedback: i64, setpoint: &Setpoint) -> i64 {
        let config = &self.config;
        if self.start_from.is_some() {
            self.filter = filter::State::steady(&config.filter, feedback);
        }
        let filtered = self.filter.step(&config.filter, feedback);
        let setpoints = [
            setpoint.velocity.to_bits(),
            setpoint.acceleration.to_bits(),
            setpoint.jerk.to_bits(),
        ];
        config.ahead(&setpoints).wrapping_add(i64::from(filtered))
    }

    /// Whether the gains for slow motion count.
    #[inline]
    fn is_calm(&mut self, error: i32, setpoint: &Setpoint) -> bool {
        let speed = setpoint.velocity.to_bits().saturating_abs();
        if speed > self.config.calm_speed {
            self.slow_ticks = 0;
            return false;
        }
        let was_calm = self.slow_ticks >= self.config.calm_ticks;
        // Eight times as much to leave as to come: the other gains, at rest, may be what makes the error.
        let bound = if was_calm {
            self.config.calm_error.saturating_mul(8)
        } else {
            self.config.calm_error
        };
        self.slow_ticks = if error.saturating_abs() <= bound {
            self.slow_ticks.saturating_add(1)
        } else {
            0
        };
        self.slow_ticks >= self.config.calm_ticks
    }

    /// Adds the transfer term, which starts as whatever keeps the output where it was.
    fn without_jump(&mut self, law: i32) -> i32 {
        if let Some(output) = self.start_from.take() {
            self.transfer = i64::from(output.to_bits()).wrapping_sub(i64::from(law));
        } else if self.transfer != 0 {
            self.transfer = decayed(self.transfer, self.config.transfer_decay);
        } else {
            return law;
        }
        saturate(i64::from(law).wrapping_add(self.transfer))
    }
}

/// The setpoint stands.
#[inline]
const fn is_at_rest(setpoint: &Setpoint) -> bool {
    setpoint.velocity.to_bits() | setpoint.acceleration.to_bits() | setpoint.jerk.to_bits() == 0
}

/// `value`·`factor`/2³¹ rounded towards zero, so that it ends at zero; |value| < 2³².
fn decayed(value: i64, factor: u32) -> i64 {
    let magnitude = value.unsigned_abs() as u32;
    let left = u64::from(magnitude)
        .wrapping_mul(u64::from(factor))
        .wrapping_shr(31)
        .cast_signed();
    if value < 0 { left.wrapping_neg() } else { left }
}
