//! Step and direction: a wrapping count of pulses as a smooth setpoint.
//!
//! The counts of a tick become d by an exact [`Ratio`]; three moving averages of n ticks each, one behind the other, make
//! of the steps a velocity whose second derivative is bounded by what a pulse train's change of speed is over n². The
//! averages are sums of whole numbers, so nothing is rounded away: at rest the setpoint is where the count says.
//!
//! **Lag.** The setpoint of a tick is the count's of 3(n − 1)/2 + 1 ticks ago: the averages, and one tick, so that velocity
//! and acceleration are central differences, true for the very instant of the position; the jerk is that of a tick
//! and a half before.
//!
//! A rate beyond the axis' largest feed is [`Fault::SetpointLost`](crate::supervisor::Fault::SetpointLost): the
//! pulses of that tick and of all later ones are not taken, so the axis comes to rest, and no setpoint ever jumps.

use super::ratio::{Carried, MAX_STEP, Ratio};
use super::{Setpoint, Turn};
use crate::estimator::saturate;
use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::units::{Acceleration, AxisScale, Jerk, Position, RangeError, Velocity};

/// Longest average, ticks.
const MAX_TICKS: usize = 32;
/// Averages behind one another.
const STAGES: u32 = 3;

parameter_table! {
    /// Step and direction: so many d for so many steps, exactly.
    pub struct StepDirParams {
        /// Electronic gear, numerator; negative turns the direction round
        step_ratio_counts: 1.0, "d", -1048576.0..=1048576.0;
        /// Electronic gear, denominator
        step_ratio_steps: 1.0, "steps", 1.0..=1048576.0;
        /// Length of each of three averages; the nearest of 1, 2, 4, 8, 16 and 32 ticks is taken
        step_smoothing_s: 0.008, "s", 0.0..=0.32;
    }
}

/// Quantised parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    ratio: Ratio,
    /// Each average is over 2^this ticks.
    bits: u32,
    /// Largest way of a tick, 2⁻¹⁶ d.
    largest: i64,
}

impl StepDirParams {
    /// Validates and quantises, for an axis whose largest velocity is `largest`.
    ///
    /// # Errors
    /// [`RangeError`] naming the parameter that is out of range.
    pub fn quantise(&self, scale: AxisScale, largest: Velocity) -> Result<Config, RangeError> {
        self.check()?;
        let ratio = Ratio::new(
            ("step_ratio_counts", self.step_ratio_counts),
            ("step_ratio_steps", self.step_ratio_steps),
        )?;
        let ticks = (self.step_smoothing_s * scale.tick_hz()).max(1.0);
        let bits = libm::round(libm::log2(ticks)) as u32;
        Ok(Config {
            ratio,
            bits: bits.min(MAX_TICKS.ilog2()),
            largest: i64::from(largest.to_bits())
                .wrapping_shr(Velocity::FRAC_NBITS - Position::FRAC_NBITS),
        })
    }
}

impl Config {
    /// How far the setpoint lies behind the count, ticks.
    #[must_use]
    pub fn lag_ticks(&self) -> f64 {
        let length = f64::from(1_u32.wrapping_shl(self.bits));
        1.5 * (length - 1.0) + 1.0
    }
}

/// The setpoint by the pulses.
#[derive(Clone, Debug)]
pub struct StepDir {
    config: Config,
    /// Pulses so far, once the first count came.
    count: Option<u32>,
    carried: Carried,
    stages: [Average; STAGES as usize],
    /// Position, 2⁻¹⁶ d, and what is below that, 2^−(16 + `sum_bits`) d.
    position: i64,
    fraction: i64,
    /// The sums of the last two ticks, the newest first.
    sums: [i64; 2],
    /// Ticks until all sums are empty.
    unrest: u32,
    is_lost: bool,
}

impl StepDir {
    /// Standing at 0 d, waiting for the first count.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            count: None,
            carried: Carried::ZERO,
            stages: [Average::EMPTY; STAGES as usize],
            position: 0,
            fraction: 0,
            sums: [0; 2],
            unrest: 0,
            is_lost: false,
        }
    }

    /// Takes over an axis that stands at `position`; the count that comes next is where it stands.
    pub fn start(&mut self, position: Position) {
        *self = Self {
            position: position.to_bits(),
            ..Self::new(self.config)
        };
    }

    /// True until the setpoint stands.
    #[must_use]
    pub const fn is_moving(&self) -> bool {
        self.unrest != 0
    }

    /// True from the first tick in which the pulses came faster than the axis may go.
    #[must_use]
    pub const fn is_lost(&self) -> bool {
        self.is_lost
    }

    /// The setpoint, by the hardware's count of pulses at this tick.
    pub fn step(&mut self, count: u32) -> Setpoint {
        let steps = count
            .wrapping_sub(self.count.unwrap_or(count))
            .cast_signed();
        self.count = Some(count);
        let way = self.taken(steps);
        if way != 0 {
            // 3(n − 1) ticks until its last in the newest sum, three more until it is out of all that are used.
            self.unrest = STAGES.wrapping_shl(self.config.bits).wrapping_add(1);
        }
        self.unrest = self.unrest.saturating_sub(1);
        let bits = self.config.bits;
        let [first, second, third] = &mut self.stages;
        let newest = third.step(second.step(first.step(way, bits), bits), bits);
        self.advance(newest)
    }

    /// The way of so many steps, 2⁻¹⁶ d.
    #[inline]
    fn taken(&mut self, steps: i32) -> i64 {
        let fits = steps.unsigned_abs() <= MAX_STEP.unsigned_abs();
        if !fits || self.is_lost {
            self.is_lost = true;
            return 0;
        }
        let way = self.config.ratio.step(&mut self.carried, steps);
        if way.unsigned_abs() > self.config.largest.unsigned_abs().wrapping_add(1) {
            self.is_lost = true;
            return 0;
        }
        way
    }

    /// Goes on to where the newest sum but one leads; its derivatives there by central differences. Sums stay below
    /// 2⁴³: 2 047 d, 16 fractional bits and three times five of the averages.
    #[inline]
    fn advance(&mut self, newest: i64) -> Setpoint {
        let [last, before] = self.sums;
        self.sums = [newest, last];
        let sum_bits = self.config.bits.wrapping_mul(STAGES);
        let whole = self.fraction.wrapping_add(last);
        self.position = self.position.wrapping_add(whole.wrapping_shr(sum_bits));
        self.fraction = whole & 1_i64.wrapping_shl(sum_bits).wrapping_sub(1);
        let acceleration = newest.wrapping_sub(last);
        let jerk = acceleration.wrapping_sub(last.wrapping_sub(before));
        let unit = Position::FRAC_NBITS.wrapping_add(sum_bits);
        Setpoint {
            position: Position::from_bits(self.position),
            velocity: Velocity::from_bits(scaled(
                newest.wrapping_add(last),
                unit.wrapping_add(1),
                Velocity::FRAC_NBITS,
            )),
            acceleration: Acceleration::from_bits(scaled(
                acceleration,
                unit,
                Acceleration::FRAC_NBITS,
            )),
            jerk: Jerk::from_bits(scaled(jerk, unit, Jerk::FRAC_NBITS)),
            turn: Turn::NONE,
        }
    }
}

/// From `from` fractional bits to `to`, rounded down; saturates.
const fn scaled(value: i64, from: u32, to: u32) -> i32 {
    if from > to {
        saturate(value.wrapping_shr(from.wrapping_sub(to)))
    } else {
        // At most 2⁴⁶, shifted by up to 13.
        saturate(value.wrapping_shl(to.wrapping_sub(from)))
    }
}

/// A moving sum.
#[derive(Clone, Copy, Debug)]
struct Average {
    samples: [i64; MAX_TICKS],
    place: u32,
    sum: i64,
}

impl Average {
    const EMPTY: Self = Self {
        samples: [0; MAX_TICKS],
        place: 0,
        sum: 0,
    };

    /// Takes a sample; the sum of the last 2^`bits`.
    #[inline]
    fn step(&mut self, sample: i64, bits: u32) -> i64 {
        let mask = 1_u32.wrapping_shl(bits).wrapping_sub(1);
        if let Some(oldest) = self.samples.get_mut(self.place as usize) {
            self.sum = self.sum.wrapping_add(sample).wrapping_sub(*oldest);
            *oldest = sample;
        }
        self.place = self.place.wrapping_add(1) & mask;
        self.sum
    }
}
