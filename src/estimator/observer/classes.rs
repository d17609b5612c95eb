//! Gains by the density of edges, and the drive's response, quantised.

use super::config::{MAX_DELAY, SIGMA_FRAC};
use super::design::{Dynamics, Matrix, Steady};
use super::motion::{COARSE_FRAC, FINE_FRAC, INNOVATION_FRAC, PLACE_FRAC};
use super::params::ObserverParams;
use super::per_tick::PerTick;
use crate::estimator::Variances;
use crate::units::{Lag, RangeError, Variance, checked};

/// Octaves of edges a tick above one: gains up to 2¹⁰ edges a tick, of which no more than 2 047 come.
const DENSE: usize = 10;
/// Octaves of edges a tick below one: gains down to an edge in 2⁷ ticks.
const SPARSE: usize = 7;
/// Ticks without an edge for which there are gains.
pub const MAX_UNSEEN: u32 = 1 << SPARSE;
/// Octaves from 2¹⁰ edges a tick to an edge in 2⁷ ticks, the densest first: what is beyond the last of them is rarer,
/// so that one comparison bounds an index.
pub const CLASSES: usize = DENSE + 1 + SPARSE;
/// The class of one edge a tick.
pub const ONE_A_TICK: usize = DENSE;

/// Exponent of the edges' density with which what the models leave unexplained falls below one edge a tick: at
/// creep the drive's errors are small, and with noise taken for as large as in full motion the gains between
/// rare edges come near to dead beat (found by closed loops on the 16K20F3 at 1 to 1.5).
const CALM: f64 = 1.5;

/// Gain of the acceleration from which on edges are taken for noisier than they are: near 3.5 a filter is dead beat, and
/// an edge that is older than the mean upsets it.
const HIGHEST_GAIN: f64 = 1.9;
/// Doublings of an edge's variance to that end.
const MOST_DOUBLINGS: u32 = 32;

/// What holds at a density of edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Class {
    /// Corrections of x, v, a and δ an innovation, with the fractional bits of [`GainScale`].
    pub gains: [i32; 4],
    /// 1/σ of the innovation, Q.12: times an innovation its high word is a number of σ in Q.8.
    pub per_sigma: i32,
    /// Half the variance of the edges' ages within a tick, ticks², Q.24.
    pub half_age_spread: i32,
    /// Lag of the acceleration.
    pub lag: Lag,
    /// Variances of velocity and acceleration without the long waves.
    pub variances: Variances,
}

impl Class {
    /// One that corrects nothing.
    pub const ZERO: Self = Self {
        gains: [0; 4],
        per_sigma: 0,
        half_age_spread: 0,
        lag: Lag::ZERO,
        variances: Variances {
            velocity: Variance::ZERO,
            acceleration: Variance::ZERO,
        },
    };
}

/// Powers of two, up to 2³⁰, by which the high words of products of gain and innovation become state. A product costs
/// less than a shift of 64 bits by a number that is not known beforehand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GainScale(pub [i32; 4]);

/// The drive's velocity response over a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Response {
    /// Velocity at full command, d/tick, Q11.20.
    pub full_velocity: i32,
    /// Velocity for no command, Q11.20.
    pub offset: i32,
    /// k₁: jerk for a gap of velocity.
    pub stiffness: i32,
    /// k₂: jerk for an acceleration, with 4 fractional bits less.
    pub damping: i32,
    /// Power of two by which k₁·gap in Q11.20 becomes a jerk in Q.56.
    pub multiplier: u32,
    /// Transport delay, ticks.
    pub delay: usize,
}

/// Density of edges of a class: 2^(10 − index) in a tick.
fn density(index: usize) -> f64 {
    libm::ldexp(1.0, (DENSE as i32).wrapping_sub(index as i32))
}

/// Steady filters of all classes, the densest first solved.
#[inline(never)]
pub fn design(per_tick: &PerTick, dynamics: &Dynamics) -> [Steady; CLASSES] {
    let mut guess: Matrix = [[0.0; 4]; 4];
    let mut steady = [Steady::default(); CLASSES];
    for (index, steady) in steady.iter_mut().enumerate() {
        let gap = 1_u32.wrapping_shl(index.saturating_sub(ONE_A_TICK) as u32);
        let dynamics = dynamics.calmed(libm::pow(density(index).min(1.0), CALM));
        let mut variance = per_tick.measurement(density(index));
        for _ in 0..MOST_DOUBLINGS {
            *steady = dynamics.steady(gap, variance, &mut guess);
            let [.., acceleration, _] = steady.gains;
            if acceleration < HIGHEST_GAIN {
                break;
            }
            variance *= 2.0;
        }
    }
    steady
}

#[inline(never)]
pub fn classes(design: &[Steady; CLASSES], scale: &GainScale, lagging: bool) -> [Class; CLASSES] {
    let mut classes = [Class::ZERO; CLASSES];
    for (index, (class, steady)) in classes.iter_mut().zip(design).enumerate() {
        // A class stands for an octave: its middle.
        let edges = density(index) * core::f64::consts::SQRT_2;
        let spread = (1.0 - 1.0 / (edges * edges)).max(0.0) / 12.0;
        let spread = if index < ONE_A_TICK { spread } else { 0.0 };
        let [velocity, acceleration] = steady.variances;
        *class = Class {
            gains: scale.quantise(&steady.gains),
            per_sigma: quantised(1.0 / libm::sqrt(steady.innovation), PER_SIGMA_FRAC),
            half_age_spread: quantised(spread / 2.0, 24),
            lag: if lagging { lag(steady) } else { Lag::ZERO },
            variances: Variances {
                velocity: variance(velocity),
                acceleration: variance(acceleration),
            },
        };
    }
    classes
}

/// Fractional bits of [`Class::per_sigma`].
const PER_SIGMA_FRAC: u32 = 32 + SIGMA_FRAC - INNOVATION_FRAC;

/// lag_a of a filter without a jerk of its own: under constant jerk J every tick's correction of a is J, so the
/// innovation is J/K_a for each tick of the gap, and what it does to v makes up for the error of a.
fn lag(steady: &Steady) -> Lag {
    let [_, velocity, acceleration, _] = steady.gains;
    Lag::saturating_from_num(velocity / acceleration - 0.5)
}

/// Largest variance of a class: with that of the long wave it stays in its format.
const MOST_VARIANCE: f64 = 16_384.0;

#[inline(never)]
pub fn variance(value: f64) -> Variance {
    Variance::saturating_from_num(value.min(MOST_VARIANCE))
}

/// `value` with `frac` fractional bits; saturates.
#[inline(never)]
pub fn quantised(value: f64, frac: u32) -> i32 {
    libm::round(libm::ldexp(value, frac as i32)) as i32
}

/// Fractional bits with which `value` comes to 2²⁹ to 2³⁰.
fn filling(value: f64) -> i32 {
    29_i32.wrapping_sub(libm::ilogb(value))
}

/// The high word of gain · innovation has so many fractional bits less than the gain.
const STATE_OF_GAIN: u32 = 32 - INNOVATION_FRAC;

impl GainScale {
    /// Shifts at which the largest gain of each kind fills a mantissa.
    pub fn holding(one: &[Steady; CLASSES], other: &[Steady; CLASSES]) -> Self {
        let mut largest = [1e-30_f64; 4];
        for steady in one.iter().chain(other) {
            for (largest, gain) in largest.iter_mut().zip(steady.gains) {
                *largest = largest.max(gain.abs());
            }
        }
        let [x, v, a, d] = largest.map(filling);
        let multiplier = |frac: i32, state: u32| {
            let highest = STATE_OF_GAIN.wrapping_add(state).cast_signed();
            let shift = highest.wrapping_sub(frac).clamp(0, 30);
            1_i32.wrapping_shl(shift.cast_unsigned())
        };
        Self([
            multiplier(x, PLACE_FRAC),
            multiplier(v, COARSE_FRAC),
            multiplier(a, FINE_FRAC),
            multiplier(d, FINE_FRAC),
        ])
    }

    /// Fractional bits of the gains.
    pub fn fracs(&self) -> [u32; 4] {
        let [x, v, a, d] = self
            .0
            .map(|multiplier| STATE_OF_GAIN.wrapping_sub(multiplier.trailing_zeros()));
        [
            x.wrapping_add(PLACE_FRAC),
            v.wrapping_add(COARSE_FRAC),
            a.wrapping_add(FINE_FRAC),
            d.wrapping_add(FINE_FRAC),
        ]
    }

    fn quantise(&self, gains: &[f64; 4]) -> [i32; 4] {
        let mut quantised = [0; 4];
        for ((gain, frac), place) in gains.iter().zip(self.fracs()).zip(&mut quantised) {
            *place = self::quantised(*gain, frac);
        }
        quantised
    }
}

/// Fractional bits of k₁ for which a velocity in Q11.20 would give a jerk without a shift.
pub const JERK_FRAC: u32 = FINE_FRAC - 20;

impl Response {
    pub fn new(params: &ObserverParams, per_tick: &PerTick, rate: f64) -> Result<Self, RangeError> {
        let delay_ticks = checked(
            "delay_ticks",
            params.delay_s * rate,
            0.0,
            MAX_DELAY as f64 + 0.49,
        )?;
        let largest = per_tick.stiffness.max(per_tick.damping.abs() / 16.0);
        let frac = filling(largest).clamp(25, 35).cast_unsigned();
        Ok(Self {
            full_velocity: quantised(per_tick.full_velocity, 20),
            offset: quantised(per_tick.full_velocity * params.offset, 20),
            stiffness: quantised(per_tick.stiffness, frac),
            damping: quantised(per_tick.damping, frac.wrapping_sub(4)),
            multiplier: 1_u32.wrapping_shl(JERK_FRAC.wrapping_sub(frac)),
            delay: libm::round(delay_ticks) as usize,
        })
    }
}
