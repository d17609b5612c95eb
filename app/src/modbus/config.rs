//! How a unit is set up on its line.

use core::fmt;

/// Address of a unit, and how long a silence ends a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    unit: u8,
    silence_us: u32,
}

/// Why a set-up was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConfigError {
    /// The address of the unit is not one of 1 to 247.
    Unit(u8),
    /// The line is not one of 300 to 4 000 000 baud.
    Baud(u32),
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unit(unit) => write!(f, "unit = {unit} is out of range: allowed 1 to 247"),
            Self::Baud(baud) => write!(f, "baud = {baud} is out of range: allowed 300 to 4000000"),
        }
    }
}

impl core::error::Error for ConfigError {}

/// Bits of a character: start, eight of data, parity or a second stop bit, stop.
const BITS_PER_CHARACTER: u32 = 11;
/// Above this rate the silence is a fixed time (Modbus over serial line 1.02, 2.5.1.1).
const FASTEST_BY_CHARACTERS: u32 = 19_200;
const SHORTEST_SILENCE_US: u32 = 1_750;

impl Config {
    /// Unit `unit` on a serial line of `baud` bits a second: a frame ends with 3.5 characters of silence, or 1.75 ms above
    /// 19 200 baud.
    ///
    /// # Errors
    /// [`ConfigError`]: what is out of range.
    pub fn serial(unit: u8, baud: u32) -> Result<Self, ConfigError> {
        if !(1..=247).contains(&unit) {
            return Err(ConfigError::Unit(unit));
        }
        if !(300..=4_000_000).contains(&baud) {
            return Err(ConfigError::Baud(baud));
        }
        let silence_us = if baud > FASTEST_BY_CHARACTERS {
            SHORTEST_SILENCE_US
        } else {
            (BITS_PER_CHARACTER * 7 * 1_000_000).div_ceil(2 * baud)
        };
        Ok(Self { unit, silence_us })
    }

    /// With another silence, µs, for a carrier that keeps no time between characters: TCP, a pseudo terminal, an
    /// emulated UART.
    #[must_use]
    pub const fn with_silence_us(self, silence_us: u32) -> Self {
        Self { silence_us, ..self }
    }

    /// Address of the unit.
    #[must_use]
    pub const fn unit(self) -> u8 {
        self.unit
    }

    /// Silence that ends a frame, µs.
    #[must_use]
    pub const fn silence_us(self) -> u32 {
        self.silence_us
    }
}
