//! From physical parameters to the integers of the tick.

use super::Model;
use super::design::{Dynamics, Matrix, Steady};
use super::motion::{COARSE_FRAC, FINE_FRAC, INNOVATION_FRAC};
use super::params::ObserverParams;
use crate::estimator::{Delay, Lags, Variances};
use crate::parameter_table::ParameterTable;
use crate::units::{AxisScale, Lag, RangeError, Variance, checked};

/// Fractional bits of [`Config::wave_slope`].
pub const WAVE_FRAC: u32 = 24;
/// Fractional bits of a normalised innovation.
pub const SIGMA_FRAC: u32 = 8;
/// Most ticks of transport delay.
pub const MAX_DELAY: usize = 63;

/// Octaves of edges a tick below one: gains up to an edge in 2⁷ ticks.
const SPARSE: usize = 7;
/// Ticks without an edge for which there are gains.
pub const MAX_UNSEEN: u32 = 1 << SPARSE;
/// Octaves from an edge in 2⁷ ticks to 2¹⁰ edges a tick.
const CLASSES: usize = 18;
/// The class of one edge a tick.
pub const ONE_A_TICK: i32 = SPARSE as i32;

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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Class {
    /// Corrections of x, v, a and δ an innovation, with the fractional bits of [`GainScale`].
    pub gains: [i32; 4],
    /// 1/σ of the innovation, Q.16.
    pub per_sigma: i32,
    /// Variances of the edges' ages within a tick, ticks², Q.28.
    pub age_spread: i32,
    /// Lag of the acceleration.
    pub lag: Lag,
    /// Variances of velocity and acceleration without the long waves.
    pub variances: Variances,
}

/// Powers of two, up to 2³⁰, by which the high words of products of gain and innovation become state. A product costs
/// less than a shift of 64 bits by a number that is not known beforehand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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

/// When the model changes, and what is rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Supervision {
    /// Silence that is rest, ticks.
    pub rest_ticks: u32,
    /// Jerk of the model that ends an assumed rest, as a state.
    pub release_jerk: i64,
    /// Mean square of the normalised innovation at which the drive's model is given up.
    pub fallback_level: i32,
    /// Ticks for which it is to be exceeded.
    pub fallback_ticks: u32,
    /// Error of the predicted acceleration, as a state.
    pub return_acceleration: i64,
    /// Ticks for which the prediction is to be that good.
    pub return_ticks: u32,
}

/// Gains, models and thresholds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    drive_classes: [Class; CLASSES],
    kinematic_classes: [Class; CLASSES],
    pub(super) gain_scale: GainScale,
    pub(super) response: Response,
    pub(super) supervision: Supervision,
    /// Variances at rest.
    pub(super) rest_variances: Variances,
    /// Velocity error a velocity that the long wave makes, Q.24.
    pub(super) wave_slope: u32,
    /// The long wave's wave number, 1/d, Q.32.
    pub(super) wave_number: u32,
    warm_up_ticks: u32,
}

/// Figures of a tick.
struct PerTick {
    full_velocity: f64,
    /// Coefficients of the jerk: −k₁ for a velocity, −k₂ for an acceleration.
    stiffness: f64,
    damping: f64,
    edge_noise: f64,
    time_noise: f64,
    model_noise: f64,
    disturbance_noise: f64,
    motion_noise: f64,
}

impl PerTick {
    fn new(params: &ObserverParams, scale: AxisScale) -> Result<Self, RangeError> {
        let rate = scale.tick_hz();
        let period_ticks = checked(
            "natural_period_ticks",
            params.natural_period_s * rate,
            8.0,
            2e4,
        )?;
        let omega = core::f64::consts::TAU / period_ticks;
        let [stiffness, damping] = response(omega, params.damping);
        let in_a_tick = 1.0 / libm::sqrt(rate);
        let acceleration = |noise: f64| scale.acceleration_from_m_s2(noise * in_a_tick);
        let velocity =
            scale.counts_from_mm(params.disturbance_noise_m_s2 * 1000.0 * in_a_tick) / rate;
        Ok(Self {
            full_velocity: checked(
                "full_command_d_per_tick",
                scale.velocity_from_feed(params.full_command_feed_mm_per_min)?,
                1e-3,
                2000.0,
            )?,
            stiffness,
            damping,
            edge_noise: params.edge_noise_d,
            time_noise: params.time_noise_s * rate,
            model_noise: acceleration(params.model_noise_m_s3),
            disturbance_noise: stiffness * velocity,
            motion_noise: acceleration(params.motion_noise_m_s3),
        })
    }

    fn drive(&self) -> Dynamics {
        Dynamics {
            jerk: [0.0, -self.stiffness, -self.damping, 1.0],
            jerk_noise: self.model_noise,
            disturbance_noise: self.disturbance_noise,
        }
    }

    fn kinematic(&self) -> Dynamics {
        Dynamics {
            jerk: [0.0; 4],
            jerk_noise: self.motion_noise,
            disturbance_noise: 0.0,
        }
    }

    /// Variance of the place that the edges of a tick give; `density` of them come in a tick.
    fn measurement(&self, density: f64) -> f64 {
        let edges = density.max(1.0);
        let in_time = density * self.time_noise;
        (self.edge_noise * self.edge_noise + in_time * in_time) / edges
    }
}

/// k₁ and k₂ of the response over a tick: the acceleration at its end is exact for a constant command.
///
/// With A = [0 1; −ω² −2ζω] of velocity and acceleration, the lower row of e^A is (−k₁, 1 − k₂), by its
/// series; ω ≤ 0.79 needs 24 terms at ζ = 10.
fn response(omega: f64, damping: f64) -> [f64; 2] {
    let (square, double) = (omega * omega, 2.0 * damping * omega);
    // Row (0, 1)·Aⁿ/n!, summed up.
    let (mut velocity, mut acceleration) = (0.0, 1.0);
    let mut sum = [0.0, 0.0];
    for term in 1..=64_u32 {
        let next_velocity = -acceleration * square;
        let next_acceleration = velocity - acceleration * double;
        velocity = next_velocity / f64::from(term);
        acceleration = next_acceleration / f64::from(term);
        sum = [sum[0] + velocity, sum[1] + acceleration];
    }
    sum.map(|share| -share)
}

/// Density of edges of a class: 2^(index − 7) in a tick.
fn density(index: usize) -> f64 {
    libm::ldexp(1.0, (index as i32).wrapping_sub(ONE_A_TICK))
}

impl Config {
    /// An observer of the axis of `params` and `scale`.
    ///
    /// Solves 36 Riccati equations by iteration, each from the solution of its neighbour.
    ///
    /// # Errors
    /// [`RangeError`] for a parameter out of range, a natural period outside 8 to 20 000 ticks, or a
    /// delay beyond 63.
    #[inline(never)]
    pub fn new(params: &ObserverParams, scale: AxisScale) -> Result<Self, RangeError> {
        params.check()?;
        let per_tick = PerTick::new(params, scale)?;
        let rate = scale.tick_hz();
        let drive = design(&per_tick, &per_tick.drive());
        let kinematic = design(&per_tick, &per_tick.kinematic());
        let gain_scale = GainScale::holding(&drive, &kinematic);
        let wave_number = core::f64::consts::TAU / scale.counts_from_mm(params.map_wave_mm);
        let slope = (params.map_residual_d * wave_number).min(64.0);
        let rest_ticks = (params.rest_s * rate).max(2.0);
        Ok(Self {
            drive_classes: classes(&drive, &gain_scale, false),
            kinematic_classes: classes(&kinematic, &gain_scale, true),
            gain_scale,
            response: Response::new(params, &per_tick, rate)?,
            supervision: Supervision::new(params, &per_tick, scale),
            rest_variances: Variances {
                velocity: variance(1.0 / (3.0 * rest_ticks * rest_ticks)),
                acceleration: variance(1.0 / libm::pow(rest_ticks, 4.0)),
            },
            wave_slope: quantised(slope, WAVE_FRAC).unsigned_abs(),
            wave_number: libm::ldexp(wave_number.min(0.999), 32) as u32,
            warm_up_ticks: warm_up(&per_tick, &kinematic),
        })
    }

    /// The observer of the 16K20F3's longitudinal axis at 1 kHz.
    ///
    /// # Errors
    /// None: the parameters are within their ranges, which a test checks.
    pub fn of_16k20f3() -> Result<Self, RangeError> {
        Self::new(&ObserverParams::default(), AxisScale::new(1000.0, 1000.0)?)
    }

    /// Lags where the drive's command is known: none, as long as its model is right.
    pub(in crate::estimator) const fn lags(&self) -> Lags {
        Lags {
            position: Lag::ZERO,
            velocity: Lag::ZERO,
            acceleration: Lag::ZERO,
        }
    }

    pub(in crate::estimator) fn delay(&self) -> Delay {
        Delay::from(&self.lags())
    }

    pub(in crate::estimator) const fn warm_up_ticks(&self) -> u32 {
        self.warm_up_ticks
    }

    /// Corrections of x, v, a and δ (d and ticks) for an innovation of 1 d at 2^`octave` edges a tick, as
    /// quantised.
    #[must_use]
    pub fn gains(&self, model: Model, octave: i32) -> [f64; 4] {
        let class = self.class(model == Model::Drive, octave.saturating_add(ONE_A_TICK));
        let mut gains = [0.0; 4];
        for ((gain, bits), frac) in gains
            .iter_mut()
            .zip(class.gains)
            .zip(self.gain_scale.fracs())
        {
            *gain = libm::ldexp(f64::from(bits), frac.cast_signed().wrapping_neg());
        }
        gains
    }

    /// Coefficients k₁, /tick², and k₂, /tick, of the drive's jerk, as quantised.
    #[must_use]
    pub fn jerk_coefficients(&self) -> [f64; 2] {
        let Response {
            stiffness,
            damping,
            multiplier,
            ..
        } = self.response;
        let frac = JERK_FRAC
            .wrapping_sub(multiplier.trailing_zeros())
            .cast_signed();
        [
            libm::ldexp(f64::from(stiffness), frac.wrapping_neg()),
            libm::ldexp(f64::from(damping), 4_i32.wrapping_sub(frac)),
        ]
    }

    /// Gains by density of edges, 2^(`octave` − 7) in a tick.
    pub(super) fn class(&self, drive: bool, octave: i32) -> &Class {
        let classes = if drive {
            &self.drive_classes
        } else {
            &self.kinematic_classes
        };
        let [slowest, .., fastest] = classes;
        if octave < 0 {
            slowest
        } else {
            classes.get(octave as usize).unwrap_or(fastest)
        }
    }
}

/// Ticks in which the kinematic filter settles at one edge a tick.
fn warm_up(per_tick: &PerTick, design: &[Steady; CLASSES]) -> u32 {
    design.get(SPARSE).map_or(0, |steady| {
        per_tick.kinematic().settling_ticks(&steady.gains)
    })
}

/// Steady filters of all classes, the densest first solved.
#[inline(never)]
fn design(per_tick: &PerTick, dynamics: &Dynamics) -> [Steady; CLASSES] {
    let mut guess: Matrix = [[0.0; 4]; 4];
    let mut steady = [Steady::default(); CLASSES];
    for (index, steady) in steady.iter_mut().enumerate().rev() {
        let gap = 1_u32.wrapping_shl(SPARSE.saturating_sub(index) as u32);
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
fn classes(design: &[Steady; CLASSES], scale: &GainScale, lagging: bool) -> [Class; CLASSES] {
    let mut classes = [Class::default(); CLASSES];
    for (index, (class, steady)) in classes.iter_mut().zip(design).enumerate() {
        // A class stands for an octave: its middle.
        let edges = density(index) * core::f64::consts::SQRT_2;
        let spread = (1.0 - 1.0 / (edges * edges)).max(0.0) / 12.0;
        let spread = if index > SPARSE { spread } else { 0.0 };
        let [velocity, acceleration] = steady.variances;
        *class = Class {
            gains: scale.quantise(&steady.gains),
            per_sigma: quantised(1.0 / libm::sqrt(steady.innovation), 16),
            age_spread: quantised(spread, 28),
            lag: if lagging { lag(steady) } else { Lag::ZERO },
            variances: Variances {
                velocity: variance(velocity),
                acceleration: variance(acceleration),
            },
        };
    }
    classes
}

/// lag_a of a filter without a jerk of its own: under constant jerk J every tick's correction of a is J, so the
/// innovation is J/K_a for each tick of the gap, and what it does to v makes up for the error of a.
fn lag(steady: &Steady) -> Lag {
    let [_, velocity, acceleration, _] = steady.gains;
    Lag::saturating_from_num(velocity / acceleration - 0.5)
}

/// Largest variance of a class: with that of the long wave it stays in its format.
const MOST_VARIANCE: f64 = 16_384.0;

#[inline(never)]
fn variance(value: f64) -> Variance {
    Variance::saturating_from_num(value.min(MOST_VARIANCE))
}

/// `value` with `frac` fractional bits; saturates.
#[inline(never)]
fn quantised(value: f64, frac: u32) -> i32 {
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
    fn holding(one: &[Steady; CLASSES], other: &[Steady; CLASSES]) -> Self {
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
            multiplier(x, COARSE_FRAC),
            multiplier(v, COARSE_FRAC),
            multiplier(a, FINE_FRAC),
            multiplier(d, FINE_FRAC),
        ])
    }

    /// Fractional bits of the gains.
    fn fracs(&self) -> [u32; 4] {
        let [x, v, a, d] = self
            .0
            .map(|multiplier| STATE_OF_GAIN.wrapping_sub(multiplier.trailing_zeros()));
        [
            x.wrapping_add(COARSE_FRAC),
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
const JERK_FRAC: u32 = FINE_FRAC - 20;

impl Response {
    fn new(params: &ObserverParams, per_tick: &PerTick, rate: f64) -> Result<Self, RangeError> {
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

impl Supervision {
    fn new(params: &ObserverParams, per_tick: &PerTick, scale: AxisScale) -> Self {
        let rate = scale.tick_hz();
        let release = params.release_mm_per_min * scale.counts_per_mm() / (rate * 60.0);
        let state = |value: f64| libm::ldexp(value.min(100.0), FINE_FRAC as i32) as i64;
        let level = params.fallback_sigmas * params.fallback_sigmas;
        Self {
            rest_ticks: (params.rest_s * rate).max(2.0) as u32,
            release_jerk: state(per_tick.stiffness * release),
            fallback_level: quantised(level, 2 * SIGMA_FRAC),
            fallback_ticks: (params.fallback_s * rate) as u32,
            return_acceleration: state(scale.acceleration_from_m_s2(params.return_m_s2)),
            return_ticks: (params.return_s * rate) as u32,
        }
    }
}
