//! Estimators: from observations to position, velocity and acceleration, with their lags.
//!
//! Each algorithm is a file with two types: a `Config`, made and checked once from physical
//! parameters, and an `Estimator` that holds the config and the state. All are primed with the first
//! sample as if the shaft had always stood there, so nothing jumps from zero. State is kept relative
//! to the newest count, which makes every algorithm independent of where on the axis it works and of
//! how long it has run.
//!
//! | name | velocity | paper |
//! | --- | --- | --- |
//! | [`difference`] | V = X − X₋₁ | P1, 1 and 2 |
//! | [`exponential`] | differenced y += α(x − y) | P2 |
//! | [`simple`] | differenced mean of N samples | P2 |
//! | [`gaussian`] | differenced one-sided Gaussian-weighted mean | P2 |
//! | [`polynomial`] | least-squares quadratic through edge samples at their times | |
//! | [`observer`] | Kalman-type, from edge times and the drive's command | |
//!
//! A further estimator is a file beside these and a line in the list at the end of this one.

pub mod difference;
pub mod exponential;
pub mod gaussian;
pub mod observer;
pub mod paths;
pub mod polynomial;
pub mod simple;

use crate::capture::Observation;
use crate::edges::{EdgeReader, EdgeSample};
use crate::uncertainty::EdgeNoise;
use crate::units::{Acceleration, Command, Lag, Position, RangeError, Variance, Velocity, checked};

/// What there is to estimate from in a tick.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a> {
    /// Counts and times.
    pub observation: &'a Observation<'a>,
    /// Reads the edges, for those that use them; it has taken note of the tick.
    pub edges: &'a EdgeReader<'a>,
    /// The sample that the edges make; may be left out where no estimator [reads edges](EstimatorConfig::reads_edges).
    pub sample: Option<EdgeSample>,
    /// What the drive was told for the tick just past; `None` where that is not known, as in a replay, or
    /// the drive was off.
    pub command: Option<Command>,
}

impl<'a> Evidence<'a> {
    /// What `observation` tells, its edges read.
    #[must_use]
    pub fn new(
        observation: &'a Observation<'a>,
        edges: &'a EdgeReader<'a>,
        command: Option<Command>,
    ) -> Self {
        Self {
            observation,
            edges,
            sample: edges.sample(observation),
            command,
        }
    }
}

/// What an estimator says after a tick; each quantity holds for the instant `lag` ticks before the
/// sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Estimate {
    /// Position, d.
    pub position: Position,
    /// Velocity, d/tick.
    pub velocity: Velocity,
    /// Acceleration, d/tick²; saturates at the range of its format.
    pub acceleration: Acceleration,
    /// How far each of the three lies back.
    pub lags: Lags,
}

/// Squares of the standard deviations (1σ) of an estimate, made when they are asked for, outside the tick. The root is
/// taken by whoever shows it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Variances {
    /// Of the velocity, (d/tick)².
    pub velocity: Variance,
    /// Of the acceleration, (d/tick²)².
    pub acceleration: Variance,
}

impl Variances {
    /// Of estimates that weigh counts with weights whose squares add up to `velocity` and `acceleration`: the
    /// rounding to whole counts, 1/12 d², taken for white.
    fn of_counts(velocity: f64, acceleration: f64) -> Self {
        Self {
            velocity: Variance::saturating_from_num(velocity / 12.0),
            acceleration: Variance::saturating_from_num(acceleration / 12.0),
        }
    }
}

/// Lags of an estimate in ticks, at low frequency: lag_x at constant velocity, lag_v at constant
/// acceleration, lag_a at constant jerk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lags {
    /// lag_x.
    pub position: Lag,
    /// lag_v.
    pub velocity: Lag,
    /// lag_a.
    pub acceleration: Lag,
}

impl Lags {
    /// Lags of a position smoothed with a lag of `position_ticks` and then differenced once and twice:
    /// each difference adds half a tick.
    fn of_differenced(position_ticks: f64) -> Self {
        Self {
            position: Lag::saturating_from_num(position_ticks),
            velocity: Lag::saturating_from_num(position_ticks + 0.5),
            acceleration: Lag::saturating_from_num(position_ticks + 1.0),
        }
    }
}

/// How an estimator's velocity and acceleration lie behind, for whoever compares them with a setpoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Delay {
    /// Mean age of what the velocity is made of, lag_v, ticks.
    pub velocity: f64,
    /// Mean square of that age, ticks²: a velocity under constant jerk j is v − lag_v·a + this·j/2.
    pub velocity_squared: f64,
    /// Mean age of what the acceleration is made of, lag_a, ticks.
    pub acceleration: f64,
}

impl Delay {
    /// Of differences of a smoothed count whose samples' ages have the variance `sample_age_variance`: a
    /// difference is the mean velocity of a tick, which adds 1/12 to it.
    fn of_differenced(lags: &Lags, sample_age_variance: f64) -> Self {
        let pure = Self::from(lags);
        Self {
            velocity_squared: pure.velocity_squared + sample_age_variance + 1.0 / 12.0,
            ..pure
        }
    }
}

impl From<&Lags> for Delay {
    /// A pure delay, which has no spread.
    fn from(lags: &Lags) -> Self {
        let velocity: f64 = lags.velocity.to_num();
        Self {
            velocity,
            velocity_squared: velocity * velocity,
            acceleration: lags.acceleration.to_num(),
        }
    }
}

/// Difference of age `age` in a motion at constant `velocity`: the fractions add up without a rest.
fn steady_delta(velocity: Velocity, age: u32) -> i32 {
    let travelled = |ticks: u32| {
        i64::from(velocity.to_bits())
            .wrapping_mul(i64::from(ticks))
            .wrapping_shr(Velocity::FRAC_NBITS)
    };
    travelled(age.wrapping_add(1)).wrapping_sub(travelled(age)) as i32
}

/// An estimate from state with `FRAC` fractional bits: the distance of the position `behind` the count's
/// middle, the velocity and its change since the previous tick. Rounds to nearest; the velocity is a mean of
/// [`Observation::delta`]s, which fit its format, the acceleration saturates.
fn estimate_from<const FRAC: u32>(
    observation: &Observation<'_>,
    behind: i64,
    velocity: i64,
    change: i64,
    quality: &Quality,
) -> Estimate {
    let rounded = |value: i64, frac: u32| shift_rounded(value, FRAC.wrapping_sub(frac));
    let behind = rounded(behind, Position::FRAC_NBITS);
    Estimate {
        position: Position::from_bits(observation.position().to_bits().wrapping_sub(behind)),
        velocity: Velocity::from_bits(rounded(velocity, Velocity::FRAC_NBITS) as i32),
        acceleration: Acceleration::from_bits(saturate(rounded(change, Acceleration::FRAC_NBITS))),
        lags: quality.lags,
    }
}

/// What is known beforehand of an estimator that weighs counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Quality {
    lags: Lags,
    variances: Variances,
}

/// Longest window of an average, samples.
const MAX_WINDOW: usize = 64;

/// A window of 1 to [`MAX_WINDOW`] samples.
fn checked_window(window: u32) -> Result<u32, RangeError> {
    checked(
        "estimator.window",
        f64::from(window),
        1.0,
        MAX_WINDOW as f64,
    )
    .map(|_| window)
}

/// `value` / 2^`bits`, to nearest. `bits` is 1 to 62 and |value| stays below 2⁶².
pub(crate) const fn shift_rounded(value: i64, bits: u32) -> i64 {
    value
        .wrapping_add(1_i64.wrapping_shl(bits.wrapping_sub(1)))
        .wrapping_shr(bits)
}

/// The nearest `i32`.
pub(crate) const fn saturate(value: i64) -> i32 {
    let low = value as i32;
    if low as i64 == value {
        low
    } else if value < 0 {
        i32::MIN
    } else {
        i32::MAX
    }
}

/// An estimator from its configuration, with gains where it has some that are solved for.
macro_rules! started {
    ($module:ident, $config:ident, $gains:ident) => {
        $module::Estimator::new(*$config)
    };
    ($module:ident, $config:ident, $gains:ident, solved) => {
        $module::Estimator::with_gains(*$config, $gains)
    };
}

/// The list: `Variant => module, "name", default config`, and `solved` for those with gains that are solved for.
macro_rules! estimators {
    ($($(#[$doc:meta])* $variant:ident => $module:ident, $name:literal, $default:expr $(, $solved:ident)?;)*) => {
        /// Configuration of any estimator.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum EstimatorConfig {
            $($(#[$doc])* $variant($module::Config),)*
        }

        impl EstimatorConfig {
            /// Names of all estimators, in order of the signal's treatment.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// The estimator's name.
            #[must_use]
            pub const fn name(&self) -> &'static str {
                match self { $(Self::$variant(_) => $name,)* }
            }

            /// The estimator of that name with the parameters that its paper found best; the observer with those of
            /// the 16K20F3 at 1 kHz.
            ///
            /// # Errors
            /// A parameter out of range (not with the values built in). `Ok(None)`: no such name.
            pub fn by_name(name: &str) -> Result<Option<Self>, RangeError> {
                $(if name == $name {
                    return Ok(Some(Self::$variant($default?)));
                })*
                Ok(None)
            }

            /// The estimator needs [`Evidence::sample`].
            #[must_use]
            pub const fn reads_edges(&self) -> bool {
                matches!(self, Self::Polynomial(_) | Self::Observer(_))
            }

            /// Lags of the estimate.
            #[must_use]
            pub const fn lags(&self) -> Lags {
                match self { $(Self::$variant(config) => config.lags(),)* }
            }

            /// How the estimate lies behind, with the spread of its age.
            #[must_use]
            pub fn delay(&self) -> Delay {
                match self { $(Self::$variant(config) => config.delay(),)* }
            }

            /// Ticks after which the first sample's influence is below 1e-6.
            #[must_use]
            pub fn warm_up_ticks(&self) -> u32 {
                match self { $(Self::$variant(config) => config.warm_up_ticks(),)* }
            }
        }

        /// Any estimator. Its number is no niche in one of them, and none is inlined beside the others, so that to choose
        /// one costs a jump.
        #[derive(Clone, Debug)]
        #[repr(u32)]
        #[expect(clippy::large_enum_variant, reason = "one per axis, and no heap to move the large one to")]
        pub enum Estimator {
            $($(#[$doc])* $variant($module::Estimator),)*
        }

        impl Estimator {
            /// The estimator that `config` describes, waiting for its first sample. Outside the tick: an observer's
            /// gains are solved for.
            #[must_use]
            pub fn new(config: EstimatorConfig) -> Self {
                Self::with_gains(&config, &config.gains().unwrap_or(observer::Gains::NONE))
            }

            /// The same, an observer with gains that were [solved](EstimatorConfig::gains) for it.
            #[must_use]
            pub fn with_gains(config: &EstimatorConfig, gains: &observer::Gains) -> Self {
                match config {
                    $(EstimatorConfig::$variant(config) => Self::$variant(started!($module, config, gains $(, $solved)?)),)*
                }
            }

            /// Starts anew as after a long motion at `velocity`. Outside the tick.
            pub fn prime(&mut self, velocity: Velocity) {
                match self { $(Self::$variant(estimator) => estimator.prime(velocity),)* }
            }

            /// Takes what a tick has to tell; what is to be said of it goes to `estimate`.
            #[inline]
            pub fn update_into(&mut self, evidence: &Evidence<'_>, estimate: &mut Estimate) {
                match self { $(Self::$variant(estimator) => estimator.update_into(evidence, estimate),)* }
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
                match self { $(Self::$variant(estimator) => estimator.variances(noise),)* }
            }
        }
    };
}

estimators! {
    /// Differences of the count.
    Difference => difference, "difference", Ok::<_, RangeError>(difference::Config);
    /// Exponential smoothing.
    Exponential => exponential, "exponential", exponential::Config::new(0.18);
    /// Simple moving average.
    Simple => simple, "simple", simple::Config::new(15);
    /// One-sided Gaussian-weighted moving average.
    Gaussian => gaussian, "gaussian", gaussian::Config::new(6.0, 25);
    /// Local polynomial through the edges.
    Polynomial => polynomial, "polynomial", polynomial::Config::new(15, polynomial::Answer::Newest);
    /// Kalman-type observer on edge times and the drive's command.
    Observer => observer, "observer", observer::Config::of_16k20f3(), solved;
}

impl EstimatorConfig {
    /// The gains of an observer, solved for: some million operations, outside the tick. `None`: it is none.
    #[must_use]
    pub fn gains(&self) -> Option<observer::Gains> {
        match self {
            Self::Observer(config) => Some(observer::Gains::solve(config)),
            _ => None,
        }
    }
}
