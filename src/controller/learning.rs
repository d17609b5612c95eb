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

use super::config::{Gains, SETPOINTS, weight};
use super::turning::Config as Turning;
use crate::estimator::observer::Line;
use crate::estimator::{Delay, Estimate, saturate};
use crate::narrowing::narrowed;
use crate::setpoint::Setpoint;
use crate::units::{Acceleration, Command, Jerk, RangeError, Velocity, checked};

/// Fractional bits of the weights beyond those of a command.
const WEIGHT_FRAC: u32 = 20;
/// Fractional bits of what is compared: a command of ±4.
const TERM_FRAC: u32 = 28;
/// Bits that a command drops for that.
const TERM_SHIFT: u32 = Command::FRAC_NBITS - TERM_FRAC;
/// Fractional bits of a share.
const SHARE_FRAC: u32 = 24;
/// Fractional bits of a covariance, and of a gain.
const COVARIANCE_FRAC: u32 = 30;
const GAIN_FRAC: u32 = 16;
/// Time constant of the low-pass, ticks: 2ⁿ; also the ticks from one time to the next.
const SMOOTHING: u32 = 2;
/// Least speed that is learned from, of that at full command.
const LEAST_SPEED: f64 = 0.02;
/// Longest delay, ticks.
const MAX_DELAY: f64 = 63.0;
/// Bounds of a share.
const LOWEST: i32 = -(3 << SHARE_FRAC) / 5;
const HIGHEST: i32 = 3 << (SHARE_FRAC - 1);
/// Variances of the shares at first: 0.2², 0.4², 0.6². The period, squared in the jerk's term, is the least certain.
const FIRST: [i32; 3] = [42_949_673, 171_798_692, 386_547_057];
/// What they grow by from one time to the next: (3e-4)², (6e-4)², (1e-3)²: drives change slowly.
const GROWTH: [i32; 3] = [107, 429, 966];

/// Quantised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Config {
    /// Full command per signal's unit of v, a and j, with [`WEIGHT_FRAC`] more bits than a command; zero: nothing is learned.
    weights: [i32; SETPOINTS],
    /// How far ahead the feedforward is, ticks, Q.8.
    lead: u32,
    /// Ticks of delay of the command.
    delay: usize,
    /// Bias, with [`TERM_FRAC`].
    bias: i32,
    /// Least speed of the setpoint, Q11.20.
    least_speed: u32,
    /// Square of the noise, with [`COVARIANCE_FRAC`].
    noise: i32,
}

impl Config {
    /// Learning of the feedforward of `gains` from estimates of `delay`, against a `noise` (1σ) and with a `bias` in fractions of
    /// full command. None with a noise of 0.
    ///
    /// # Errors
    /// [`RangeError`] for estimates that lag, a full-command speed below 1 d/tick, or a delay beyond 63 ticks.
    pub fn new(gains: &Gains, delay: Delay, bias: f64, noise: f64) -> Result<Self, RangeError> {
        if checked("learning_noise", noise, 0.0, 0.1)? == 0.0 {
            return Ok(Self::default());
        }
        let lag = delay.velocity.max(delay.acceleration);
        checked(
            "lag of the estimates that are learned from, ticks",
            lag,
            0.0,
            0.0,
        )?;
        let by_v = checked(
            "velocity_feedforward, per d/tick",
            gains.velocity_feedforward,
            1e-6,
            1.0,
        )?;
        let by_a = checked(
            "acceleration_feedforward, per d/tick²",
            gains.acceleration_feedforward,
            0.0,
            10.0,
        )?;
        let by_j = checked(
            "jerk_feedforward, per d/tick³",
            gains.jerk_feedforward,
            0.0,
            500.0,
        )?;
        let lead = checked(
            "feedforward_lead_ticks",
            gains.feedforward_lead,
            0.0,
            MAX_DELAY,
        )?;
        let fixed =
            |value: f64, frac: u32| libm::round(libm::ldexp(value, frac.cast_signed())) as i32;
        let scaled = |gain: f64, frac: u32| fixed(weight(gain, frac), WEIGHT_FRAC);
        Ok(Self {
            weights: [
                scaled(by_v, Velocity::FRAC_NBITS),
                scaled(by_a, Acceleration::FRAC_NBITS),
                scaled(by_j, Jerk::FRAC_NBITS),
            ],
            lead: fixed(lead, LEAD_FRAC) as u32,
            delay: libm::floor(lead) as usize,
            bias: fixed(bias, TERM_FRAC),
            least_speed: fixed(LEAST_SPEED / by_v, Velocity::FRAC_NBITS) as u32,
            noise: fixed(noise * noise, COVARIANCE_FRAC).max(1),
        })
    }

    /// There is something to do.
    #[inline]
    #[must_use]
    pub const fn is_on(&self) -> bool {
        self.noise != 0
    }

    /// Whole ticks of the lead.
    pub(super) const fn horizon(&self) -> u32 {
        self.lead.wrapping_shr(LEAD_FRAC)
    }

    /// Terms of v, a and j in command, with [`TERM_FRAC`].
    fn terms(&self, signals: [i32; SETPOINTS]) -> [i32; SETPOINTS] {
        let mut terms = [0; SETPOINTS];
        for ((term, weight), signal) in terms.iter_mut().zip(self.weights).zip(signals) {
            let product = i64::from(weight).wrapping_mul(i64::from(signal));
            *term = saturate(product.wrapping_shr(WEIGHT_FRAC + TERM_SHIFT));
        }
        terms
    }
}

/// Fractional bits of the lead.
const LEAD_FRAC: u32 = 8;

/// What has been learned, ready for the tick.
#[derive(Clone, Copy, Debug, Default)]
struct Addition {
    /// Weights of the setpoint's v, a and j, the lead in them.
    weights: [i32; SETPOINTS],
    turning: Turning,
}

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
    shares: [i32; 3],
    /// P.
    covariance: [[i32; 3]; 3],
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
        let [v, a, j] = FIRST;
        Self {
            line: Line::new(),
            command: 0,
            velocity: 0,
            acceleration: 0,
            last_acceleration: 0,
            ticks: 0,
            added: 0,
            addition: Addition {
                weights: [0; SETPOINTS],
                turning: Turning::NONE,
            },
            shares: [0; 3],
            covariance: [[v, 0, 0], [0, a, 0], [0, 0, j]],
            last_error: 0,
            scatter: 0,
        }
    }

    /// Shares αᵢ of the feedforward's terms of v, a and j.
    #[must_use]
    pub fn shares(&self) -> [f64; 3] {
        self.shares
            .map(|share| libm::ldexp(f64::from(share), SHARE_FRAC.cast_signed().wrapping_neg()))
    }

    /// What has been added to the last demand, Q.30.
    #[inline]
    #[must_use]
    pub const fn added(&self) -> i32 {
        self.added
    }

    /// A level of friction as the drive's gain has turned out: (1 + α_v)·level.
    #[inline]
    #[must_use]
    pub fn scaled(&self, level: i32) -> i32 {
        let [gain, ..] = self.shares;
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
        self.correct(&instrument, error, noise);
        self.addition = Addition::new(config, &self.shares);
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
        for (term, share) in terms.into_iter().zip(self.shares) {
            let whole = i64::from(share).wrapping_add(1 << SHARE_FRAC);
            let asked = i64::from(term).wrapping_mul(whole).wrapping_shr(SHARE_FRAC);
            error = error.wrapping_sub(asked);
        }
        saturate(error)
    }

    /// The Kalman filter's step.
    fn correct(&mut self, instrument: &[i32; 3], error: i32, noise: i32) {
        let weighed = self.covariance.map(|row| dot(&row, instrument));
        let spread = dot(&weighed, instrument);
        if spread < 0 {
            // Rounding has made a variance negative: it begins anew, with what it has learned.
            self.covariance = Self::new().covariance;
            return;
        }
        let (inverse, shift) = inverse(spread.saturating_add(noise).unsigned_abs());
        let gains = weighed.map(|weighed| {
            let gain = i64::from(weighed).wrapping_mul(i64::from(inverse));
            saturate(gain.wrapping_shr(shift))
        });
        for (share, gain) in self.shares.iter_mut().zip(gains) {
            let more = i64::from(gain)
                .wrapping_mul(i64::from(error))
                .wrapping_shr(GAIN_FRAC + TERM_FRAC - SHARE_FRAC);
            *share = saturate(i64::from(*share).wrapping_add(more)).clamp(LOWEST, HIGHEST);
        }
        for (row, gain) in self.covariance.iter_mut().zip(gains) {
            for (entry, weighed) in row.iter_mut().zip(weighed) {
                let less = i64::from(gain)
                    .wrapping_mul(i64::from(weighed))
                    .wrapping_shr(GAIN_FRAC);
                *entry = saturate(i64::from(*entry).wrapping_sub(less));
            }
        }
        self.grow();
    }

    /// The variances grow, up to what they were at first.
    fn grow(&mut self) {
        let [[v, ..], [_, a, _], [.., j]] = &mut self.covariance;
        for ((variance, more), most) in [v, a, j].into_iter().zip(GROWTH).zip(FIRST) {
            *variance = variance.max(&mut 0).saturating_add(more).min(most);
        }
    }
}

impl Addition {
    fn new(config: &Config, shares: &[i32; 3]) -> Self {
        let mut scaled = [0_i64; SETPOINTS];
        for ((scaled, weight), share) in scaled.iter_mut().zip(config.weights).zip(shares) {
            *scaled = i64::from(weight)
                .wrapping_mul(i64::from(*share))
                .wrapping_shr(SHARE_FRAC);
        }
        let [by_v, by_a, by_j] = scaled;
        let lead = i64::from(config.lead);
        // By τ, from the format of one derivative to that of the next.
        let led = |weight: i64, from: u32, to: u32| {
            weight
                .wrapping_mul(lead)
                .wrapping_shr(LEAD_FRAC.wrapping_add(to).wrapping_sub(from))
        };
        let of_v_by_a = led(by_v, Velocity::FRAC_NBITS, Acceleration::FRAC_NBITS);
        let of_a_by_j = led(by_a, Acceleration::FRAC_NBITS, Jerk::FRAC_NBITS);
        let of_v_by_j = led(of_v_by_a, Acceleration::FRAC_NBITS, Jerk::FRAC_NBITS).wrapping_shr(1);
        let in_jerk =
            |weight: i64, frac: u32| weight.wrapping_shr(Jerk::FRAC_NBITS.wrapping_sub(frac));
        Self {
            weights: [
                saturate(by_v),
                saturate(by_a.wrapping_add(of_v_by_a)),
                saturate(by_j.wrapping_add(of_a_by_j).wrapping_add(of_v_by_j)),
            ],
            turning: Turning::of_weights(
                config.lead,
                saturate(in_jerk(by_v, Velocity::FRAC_NBITS).wrapping_shr(1)),
                saturate(in_jerk(by_a, Acceleration::FRAC_NBITS)),
                saturate(by_j),
            ),
        }
    }

    /// Command for a setpoint, Q.30; saturates.
    #[inline]
    fn command(&self, setpoint: &Setpoint, turns: bool) -> i32 {
        let [by_v, by_a, by_j] = self.weights.map(i64::from);
        let sum = by_v
            .wrapping_mul(i64::from(setpoint.velocity.to_bits()))
            .wrapping_add(by_a.wrapping_mul(i64::from(setpoint.acceleration.to_bits())))
            .wrapping_add(by_j.wrapping_mul(i64::from(setpoint.jerk.to_bits())));
        let command = narrowed::<WEIGHT_FRAC>(sum);
        if turns {
            command.saturating_add(self.turning.command(setpoint))
        } else {
            command
        }
    }
}

/// `state` goes 2⁻ⁿ of the way to `value`.
#[inline]
const fn smooth(state: &mut i32, value: i32) {
    *state = state.wrapping_add(value.saturating_sub(*state).wrapping_shr(SMOOTHING));
}

/// Σ aᵢ·bᵢ of a vector and terms, in the format of the former.
fn dot(vector: &[i32; 3], terms: &[i32; 3]) -> i32 {
    let products = vector.iter().zip(terms);
    let sum = products.fold(0_i64, |sum, (a, b)| {
        sum.wrapping_add(i64::from(*a).wrapping_mul(i64::from(*b)))
    });
    saturate(sum.wrapping_shr(TERM_FRAC))
}

/// 1/`value` as a factor of a covariance and the shift that makes a gain of the product; by a 32-bit division, right to 2⁻¹⁵.
const fn inverse(value: u32) -> (u32, u32) {
    let room = if value == 0 {
        31
    } else {
        value.leading_zeros()
    };
    let coarse = value.wrapping_shl(room).wrapping_shr(16);
    let inverse = match (1_u32 << 31).checked_div(coarse) {
        Some(inverse) => inverse,
        None => 0,
    };
    // 2³⁰/value = inverse·2^(room − 17); a gain has GAIN_FRAC of that.
    (
        inverse,
        (17 + COVARIANCE_FRAC - GAIN_FRAC).wrapping_sub(room),
    )
}
