//! From setpoint and estimate to a demand on the drive: PID with feedforward and corrective links.
//!
//! ```text
//! u = bias + kp·e + ki·Σe + kd·Δe                     PID on position, e = x_set − x
//!   + kv·(v_ref − v̂) + ka·(a_ref − â)                 the papers' corrective links (P2)
//!   + ff_v·v_set + ff_a·a_set + ff_j·j_set            feedforward
//!   + transfer                                        decays to zero, see below
//! ```
//!
//! An estimate holds for an instant `lag` ticks ago, so the links compare it with the setpoint of that
//! instant: v_ref = v − lag_v·a + ⟨lag_v²⟩·j/2, a_ref = a − lag_a·j, where ⟨lag_v²⟩ is the mean square age of
//! what the velocity is made of ([`Delay`](crate::estimator::Delay)). Since an estimator's lags are known
//! beforehand, [`Config`] folds them into the weights of a and j.
//!
//! At enable and at a change of parameters the law would jump; the jump is taken up by `transfer`,
//! which then decays geometrically, so the output stays continuous. Integration stops while the output
//! is limited in the direction in which the error would drive it further, and the integral itself
//! stays within ±1.

pub mod config;

pub use config::Config;

use crate::estimator::Estimate;
use crate::output::ActiveLimits;
use crate::setpoint::Setpoint;
use crate::units::{Command, Position};

use crate::estimator::saturate;
use config::INTEGRAL_SHIFT;

/// Following error x_set − x in Q15.16 d; saturates at ±32 768 d.
pub type FollowingError = fixed::types::I16F16;

/// Controller state.
#[derive(Clone, Debug)]
pub struct Controller {
    config: Config,
    /// ki·Σe, fractions of full command with 30 + [`INTEGRAL_SHIFT`] fractional bits.
    integral: i64,
    /// Error of the previous tick, less the deadband.
    previous_error: i32,
    previous_following_error: i32,
    /// There was no previous tick.
    fresh: bool,
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
            integral: 0,
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
        self.integrate(error, active);

        let integral = self.integral.wrapping_shr(INTEGRAL_SHIFT);
        let law = saturate(self.config.weigh(&signals).wrapping_add(integral));
        let command = self.without_jump(law);
        Demand {
            command: Command::from_bits(command),
            following_error,
        }
    }

    /// Adds the error to the integral unless the output is at a limit and the error drives into it.
    fn integrate(&mut self, error: i32, active: ActiveLimits) {
        let increment = i64::from(error).wrapping_mul(i64::from(self.config.integral_gain));
        let driven_further = (increment > 0 && active.high) || (increment < 0 && active.low);
        if !driven_further {
            let full = i64::from(Command::ONE.to_bits()).wrapping_shl(INTEGRAL_SHIFT);
            self.integral = self
                .integral
                .wrapping_add(increment)
                .clamp(full.wrapping_neg(), full);
        }
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

/// `value`·`factor`/2³¹ rounded towards zero, so that it ends at zero; |value| < 2³².
fn decayed(value: i64, factor: u32) -> i64 {
    let magnitude = value.unsigned_abs() as u32;
    let left = u64::from(magnitude)
        .wrapping_mul(u64::from(factor))
        .wrapping_shr(31)
        .cast_signed();
    if value < 0 { left.wrapping_neg() } else { left }
}
