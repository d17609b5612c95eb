//! The feedforward's gains as the drive shows them in motion.
//!
//! A drive of second order asks for u = ff_v·v + ff_a·a + ff_j·j. Where its gain, period or damping are not what the feedforward was
//! made for, each term is off by a share αᵢ. What the command was for, and what came of it, shows them:
//!
//! ε = u − Σ (1 + αᵢ)·cᵢ, cᵢ = ffᵢ·(v̂, â, ĵ),
//!
//! all of it through the same low-pass 1/(1 + 4·s), which makes ĵ out of â without differentiating noise. u is the command of the drive's delay ago,
//! without what friction takes and without the bias. Every fourth tick in motion a Kalman filter of the three shares takes ε,
//!
//! K = P·q/(qᵀ·P·q + R), α += K·ε, P −= K·qᵀ·P,
//!
//! with the setpoint's terms q for an instrument: they are free of the estimates' noise, which would draw the shares towards −1. R is eight times
//! the mean square by which ε differs from one time to the next, and the set `noise`² besides.
//!
//! It asks whether command and motion agree, not whether the axis is where it should be: it is no feedback, and takes nothing
//! from the loop's margins. What is learned is added to the feedforward, and withheld from an observer, which so keeps the
//! motion of the drive that it knows. An axis that does not follow to within half of its speed teaches nothing: it is
//! blocked. Shares stay within −0.6 to 1.5. They are kept until other gains are set.

mod addition;
mod config;
mod shares;

pub use config::Config;

use addition::Addition;
use shares::{COVARIANCE_FRAC, SHARE_FRAC, Shares};

use crate::estimator::observer::Line;
use crate::estimator::{Estimate, saturate};
use crate::setpoint::Setpoint;
use crate::units::{Acceleration, Command, Jerk, Velocity};

/// Fractional bits of what is compared: a command of ±4.
const TERM_FRAC: u32 = 28;
/// Bits that a command drops for that.
const TERM_SHIFT: u32 = Command::FRAC_NBITS - TERM_FRAC;
/// Time constant of the low-pass, ticks: 2ⁿ; also the ticks from one time to the next.
const SMOOTHING: u32 = 2;

/// State of the learning.
#[derive(Clone, Debug)]
pub struct State {
    line: Line,
    /// Low-passed: the command with [`TERM_FRAC`], velocity and acceleration in their formats.
    command: i32,
    velocity: i32,
    acceleration: i32,
    /// The low-passed acceleration of the tick before.
    last_acceleration: i32,
    ticks: u32,
    /// What is added now, Q.30.
    added: i32,
    addition: Addition,
    shares: Shares,
    /// ε of the last time, and mean square of its change.
    last_error: i32,
    scatter: i32,
}

impl Default for State {
    fn default() -> Self {
        Self::new()
    }
}

impl State {
    /// Nothing learned.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            line: Line::new(),
            command: 0,
            velocity: 0,
            acceleration: 0,
            last_acceleration: 0,
            ticks: 0,
            added: 0,
            addition: Addition::NONE,
            shares: Shares::new(),
            last_error: 0,
            scatter: 0,
        }
    }

    /// Shares αᵢ of the feedforward's terms of v, a and j.
    #[must_use]
    pub fn shares(&self) -> [f64; 3] {
        self.shares
            .values()
            .map(|share| libm::ldexp(f64::from(share), SHARE_FRAC.cast_signed().wrapping_neg()))
    }

    /// A level of friction as the drive's gain has turned out: (1 + α_v)·level.
    #[inline]
    #[must_use]
    pub fn scaled(&self, level: i32) -> i32 {
        let [gain, ..] = *self.shares.values();
        let more = i64::from(level)
            .wrapping_mul(i64::from(gain))
            .wrapping_shr(SHARE_FRAC);
        level.saturating_add(more as i32)
    }

    /// Takes the command of the tick just past, as an observer is told of it, and what came of it.
    #[inline]
    pub fn note(&mut self, config: &Config, command: Option<Command>, estimate: &Estimate) {
        let whole =
            command.map(|command| Command::from_bits(command.to_bits().saturating_add(self.added)));
        let Some(whole) = self.line.pass(whole, config.delay) else {
            return;
        };
        let command = whole.wrapping_shr(TERM_SHIFT).wrapping_sub(config.bias);
        smooth(&mut self.command, command);
        smooth(&mut self.velocity, estimate.velocity.to_bits());
        self.last_acceleration = self.acceleration;
        smooth(&mut self.acceleration, estimate.acceleration.to_bits());
    }

    /// Counts a tick: true in every fourth one in motion, in which there is to be [`learned`](Self::learn).
    #[inline]
    pub fn is_due(&mut self, config: &Config, setpoint: &Setpoint) -> bool {
        self.ticks = self.ticks.wrapping_add(1);
        self.ticks.trailing_zeros() >= SMOOTHING
            && setpoint.velocity.to_bits().unsigned_abs() >= config.least_speed
    }

    /// What is to be added to the law, Q.30; `turns` where the jerk of the setpoint may change within the feedforward's lead.
    #[inline]
    pub fn add(&mut self, setpoint: &Setpoint, turns: bool) -> i32 {
        self.added = self.addition.command(setpoint, turns);
        self.added
    }

    /// Learns from what has been noted; by how much that changes what is to be added, Q.30.
    #[cold]
    #[inline(never)]
    pub fn learn(&mut self, config: &Config, setpoint: &Setpoint) -> i32 {
        if !self.follows(setpoint) {
            return 0;
        }
        let before = self.addition.command(setpoint, true);
        self.take(config, setpoint);
        let after = self.addition.command(setpoint, true);
        after.saturating_sub(before)
    }

    /// The axis moves with the setpoint, to within half of its speed: one that is blocked, or whose encoder is lost, teaches nothing.
    fn follows(&self, setpoint: &Setpoint) -> bool {
        let speed = setpoint.velocity.to_bits();
        let missing = speed.saturating_sub(self.velocity).unsigned_abs();
        missing <= speed.unsigned_abs().wrapping_shr(1)
    }

    fn take(&mut self, config: &Config, setpoint: &Setpoint) {
        let error = self.error(config);
        let step = saturate(i64::from(error).wrapping_sub(i64::from(self.last_error)));
        self.last_error = error;
        // Half the square of the step is the variance of either; as a covariance.
        let square = i64::from(step)
            .wrapping_mul(i64::from(step))
            .wrapping_shr(2 * TERM_FRAC - COVARIANCE_FRAC + 1);
        let scatter = saturate(square).saturating_sub(self.scatter);
        self.scatter = self.scatter.saturating_add(scatter.wrapping_shr(2));
        let instrument = config.terms([
            setpoint.velocity.to_bits(),
            setpoint.acceleration.to_bits(),
            setpoint.jerk.to_bits(),
        ]);
        let noise = self.scatter.saturating_mul(8).saturating_add(config.noise);
        self.shares.correct(&instrument, error, noise);
        self.addition = Addition::new(config, self.shares.values());
    }

    /// ε, with [`TERM_FRAC`]. Command, velocity and acceleration are brought to the middle of the tick that the jerk is of.
    fn error(&self, config: &Config) -> i32 {
        const HALF_A: u32 = Acceleration::FRAC_NBITS - Velocity::FRAC_NBITS + 1;
        const HALF_J: u32 = Jerk::FRAC_NBITS - Acceleration::FRAC_NBITS + 1;
        // Change of the acceleration in a tick.
        let jerk = self
            .acceleration
            .saturating_sub(self.last_acceleration)
            .saturating_mul(1 << (Jerk::FRAC_NBITS - Acceleration::FRAC_NBITS));
        let terms = config.terms([
            self.velocity
                .saturating_sub(self.acceleration.wrapping_shr(HALF_A)),
            self.acceleration.saturating_sub(jerk.wrapping_shr(HALF_J)),
            jerk,
        ]);
        let mut error = i64::from(self.command);
        for (term, share) in terms.into_iter().zip(*self.shares.values()) {
            let whole = i64::from(share).wrapping_add(1 << SHARE_FRAC);
            let asked = i64::from(term).wrapping_mul(whole).wrapping_shr(SHARE_FRAC);
            error = error.wrapping_sub(asked);
        }
        saturate(error)
    }
}

/// `state` goes 2⁻ⁿ of the way to `value`.
#[inline]
const fn smooth(state: &mut i32, value: i32) {
    *state = state.wrapping_add(value.saturating_sub(*state).wrapping_shr(SMOOTHING));
}
