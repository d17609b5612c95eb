//! Units of the axis and the conversions at its door (paper P1, formulas 1 to 8).
//!
//! Inside the tick everything is measured in **d** (one discrete: the x4 count of the encoder) and
//! **ticks** (one control period), in the fixed-point formats below. The formats differ from one
//! another, so the compiler keeps a velocity from being used as an acceleration. Physical units
//! appear only here, in `f64`, while a configuration is being made.
//!
//! | quantity | type | range | one LSB |
//! | --- | --- | --- | --- |
//! | position, d | [`Position`] | ±1.4e14 | 1.5e-5 |
//! | velocity, d/tick | [`Velocity`] | ±2 048 | 9.5e-7 |
//! | acceleration, d/tick² | [`Acceleration`] | ±128 | 6.0e-8 |
//! | jerk, d/tick³ | [`Jerk`] | ±4 | 1.9e-9 |
//! | lag, ticks | [`Lag`] | ±32 768 | 1.5e-5 |
//! | variance of one of these, its unit² | [`Variance`] | 65 536 (σ 256) | 3.6e-15 (σ 6e-8) |
//! | command, fraction of full | [`Command`] | ±2 (limited to ±1) | 9.3e-10 |

use core::fmt;

use fixed::types::{I2F30, I3F29, I8F24, I12F20, I16F16, I48F16, U16F48};

/// Position in d.
pub type Position = I48F16;
/// Velocity in d/tick.
pub type Velocity = I12F20;
/// Acceleration in d/tick².
pub type Acceleration = I8F24;
/// Jerk in d/tick³, as the feedforward sees it; a trajectory keeps its own finer state.
pub type Jerk = I3F29;
/// Lag of an estimate behind the sampling instant, in ticks.
pub type Lag = I16F16;
/// Variance of a velocity, (d/tick)², or of an acceleration, (d/tick²)².
pub type Variance = U16F48;
/// Drive command in fractions of full command: ±1 is ±10 V.
pub type Command = I2F30;

/// Gravity by which an overload `n` is counted, m/s²: what the paper computes with.
pub const PAPER_GRAVITY_M_S2: f64 = 9.81;

/// A quantity outside the range in which a conversion makes sense.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeError {
    /// Name of the quantity, with its unit as a suffix.
    pub name: &'static str,
    /// The value that was refused.
    pub value: f64,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
}

impl fmt::Display for RangeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name,
            value,
            min,
            max,
        } = self;
        write!(
            f,
            "{name} = {value} is out of range: allowed {min} to {max}"
        )
    }
}

impl core::error::Error for RangeError {}

/// Passes `value` on if it is a number within `min..=max`.
///
/// # Errors
/// [`RangeError`] with the name, the value and the range; NaN is always out of range.
// A call: three comparisons of `f64` in software and an error to fill are long, and there are hundreds of them.
#[inline(never)]
pub fn checked(name: &'static str, value: f64, min: f64, max: f64) -> Result<f64, RangeError> {
    if (min..=max).contains(&value) {
        Ok(value)
    } else {
        Err(RangeError {
            name,
            value,
            min,
            max,
        })
    }
}

/// Tick rates the core runs at, Hz.
pub const TICK_HZ: (f64, f64) = (100.0, 40_000.0);
/// Clocks of the edge timer the core accepts, Hz.
pub const TIMER_HZ: (f64, f64) = (1e6, 250e6);
const COUNTS_PER_MM: (f64, f64) = (1e-3, 1e7);
const FEED_MM_PER_MIN: (f64, f64) = (-1e6, 1e6);
const OVERLOAD_G: (f64, f64) = (-1e3, 1e3);
const LINE_HZ: (f64, f64) = (1e-3, 1e9);
const ROTATION_RPM: (f64, f64) = (1e-3, 1e6);
const LINES: (f64, f64) = (1.0, 1e7);
const TRAVEL_MM: (f64, f64) = (1e-6, 1e4);

/// Conversions between the units of the shop floor and those of the tick, for one axis. Feeds and overloads,
/// which people type, are checked; the others scale a value that the caller has checked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisScale {
    counts_per_mm: f64,
    tick_hz: f64,
}

impl AxisScale {
    /// A scale of `counts_per_mm` (K of the paper, d/mm) at a control rate of `tick_hz` (f).
    ///
    /// # Errors
    /// [`RangeError`] for a resolution outside 0.001 to 1e7 d/mm or a rate outside 100 Hz to 40 kHz.
    pub fn new(counts_per_mm: f64, tick_hz: f64) -> Result<Self, RangeError> {
        Ok(Self {
            counts_per_mm: checked(
                "counts_per_mm",
                counts_per_mm,
                COUNTS_PER_MM.0,
                COUNTS_PER_MM.1,
            )?,
            tick_hz: checked("tick_hz", tick_hz, TICK_HZ.0, TICK_HZ.1)?,
        })
    }

    /// Encoder resolution K, d/mm.
    #[must_use]
    pub const fn counts_per_mm(self) -> f64 {
        self.counts_per_mm
    }

    /// Control rate f, Hz.
    #[must_use]
    pub const fn tick_hz(self) -> f64 {
        self.tick_hz
    }

    /// Velocity in d/tick of a feed in mm/min: V = F·K/(60·f) (P1, formula 3).
    ///
    /// # Errors
    /// [`RangeError`] for a feed beyond ±1e6 mm/min.
    pub fn velocity_from_feed(self, feed_mm_per_min: f64) -> Result<f64, RangeError> {
        let feed = checked(
            "feed_mm_per_min",
            feed_mm_per_min,
            FEED_MM_PER_MIN.0,
            FEED_MM_PER_MIN.1,
        )?;
        Ok(feed * self.counts_per_mm / (self.tick_hz * 60.0))
    }

    /// Feed in mm/min of a velocity in d/tick (P1, formula 3 turned round).
    #[must_use]
    pub fn feed_from_velocity(self, velocity_d_per_tick: f64) -> f64 {
        velocity_d_per_tick * self.tick_hz * 60.0 / self.counts_per_mm
    }

    /// Acceleration in d/tick² of an overload in g: a = 1000·n·g·K/f² (P1, formula 4).
    ///
    /// # Errors
    /// [`RangeError`] for an overload beyond ±1 000 g.
    pub fn acceleration_from_overload(self, overload_g: f64) -> Result<f64, RangeError> {
        let overload = checked("overload_g", overload_g, OVERLOAD_G.0, OVERLOAD_G.1)?;
        Ok(self.acceleration_from_m_s2(overload * PAPER_GRAVITY_M_S2))
    }

    /// Overload in g of an acceleration in d/tick² (P1, formula 4 turned round).
    #[must_use]
    pub fn overload_from_acceleration(self, acceleration_d_per_tick2: f64) -> f64 {
        let m_s2 =
            acceleration_d_per_tick2 * self.tick_hz * self.tick_hz / (1000.0 * self.counts_per_mm);
        m_s2 / PAPER_GRAVITY_M_S2
    }

    /// Acceleration in d/tick² of one in m/s².
    #[must_use]
    pub fn acceleration_from_m_s2(self, acceleration_m_s2: f64) -> f64 {
        1000.0 * acceleration_m_s2 * self.counts_per_mm / (self.tick_hz * self.tick_hz)
    }

    /// Jerk in d/tick³ of one in m/s³.
    #[must_use]
    pub fn jerk_from_m_s3(self, jerk_m_s3: f64) -> f64 {
        1000.0 * jerk_m_s3 * self.counts_per_mm / (self.tick_hz * self.tick_hz * self.tick_hz)
    }

    /// Position in d of one in mm.
    #[must_use]
    pub fn counts_from_mm(self, position_mm: f64) -> f64 {
        position_mm * self.counts_per_mm
    }

    /// Position in mm of one in d.
    #[must_use]
    pub fn mm_from_counts(self, position_d: f64) -> f64 {
        position_d / self.counts_per_mm
    }
}

/// Frequency of one encoder channel in Hz at a speed: f_I = n·Z/60 (P1, formula 5).
///
/// # Errors
/// [`RangeError`] for a speed outside 0.001 to 1e6 rpm or lines outside 1 to 1e7.
pub fn line_frequency_hz(rotation_rpm: f64, lines: f64) -> Result<f64, RangeError> {
    let rotation = checked("rotation_rpm", rotation_rpm, ROTATION_RPM.0, ROTATION_RPM.1)?;
    Ok(rotation * checked("lines", lines, LINES.0, LINES.1)? / 60.0)
}

/// Most lines a revolution that a linear axis can use: Z = f_I·h·60/F (P1, formula 6), with `line_hz` the
/// highest channel frequency and `travel_mm` (h) the travel per revolution of the encoder.
///
/// # Errors
/// [`RangeError`] for arguments that no encoder or machine has.
pub fn lines_for_feed(
    line_hz: f64,
    travel_mm: f64,
    feed_mm_per_min: f64,
) -> Result<f64, RangeError> {
    let line_hz = checked("line_hz", line_hz, LINE_HZ.0, LINE_HZ.1)?;
    let travel = checked("travel_mm", travel_mm, TRAVEL_MM.0, TRAVEL_MM.1)?;
    let feed = checked("feed_mm_per_min", feed_mm_per_min, 1e-6, FEED_MM_PER_MIN.1)?;
    Ok(line_hz * travel * 60.0 / feed)
}

/// Most lines a revolution that a spindle can use: Z = f_I·60/n (P1, formula 7).
///
/// # Errors
/// [`RangeError`] for arguments that no encoder or spindle has.
pub fn lines_for_rotation(line_hz: f64, rotation_rpm: f64) -> Result<f64, RangeError> {
    let line_hz = checked("line_hz", line_hz, LINE_HZ.0, LINE_HZ.1)?;
    let rotation = checked("rotation_rpm", rotation_rpm, ROTATION_RPM.0, ROTATION_RPM.1)?;
    Ok(line_hz * 60.0 / rotation)
}

/// One discrete in mm: d = h/(4·Z) (P1, formula 8; x4 counting).
///
/// # Errors
/// [`RangeError`] for arguments that no encoder or machine has.
pub fn discrete_mm(travel_mm: f64, lines: f64) -> Result<f64, RangeError> {
    let travel = checked("travel_mm", travel_mm, TRAVEL_MM.0, TRAVEL_MM.1)?;
    Ok(travel / (4.0 * checked("lines", lines, LINES.0, LINES.1)?))
}
