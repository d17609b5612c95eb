//! The last stage before the drive: limit and slew, and which of them is active.

use crate::units::{Command, RangeError, checked};

/// Quantised limits of the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    limit: i32,
    slew: i32,
}

impl Config {
    /// A limit of `limit` in fractions of full command and a slew of at most `slew_per_tick` each tick.
    ///
    /// # Errors
    /// [`RangeError`] unless 0 < limit ≤ 1 and 1e-6 ≤ slew ≤ 2 (2: none).
    pub fn new(limit: f64, slew_per_tick: f64) -> Result<Self, RangeError> {
        let limit = checked("output_limit", limit, 1e-4, 1.0)?;
        let slew = checked("output_slew_per_tick", slew_per_tick, 1e-6, 2.0)?;
        Ok(Self {
            limit: Command::saturating_from_num(limit).to_bits(),
            slew: Command::saturating_from_num(slew).to_bits(),
        })
    }
}

/// Limits that hold the output back; being limited is a state, not a fault.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ActiveLimits {
    /// The demand is above what may be put out.
    pub high: bool,
    /// The demand is below what may be put out.
    pub low: bool,
    /// It is the slew that holds the output back.
    pub slew: bool,
}

impl ActiveLimits {
    /// The demand is beyond what may be put out.
    #[must_use]
    #[inline(always)]
    pub const fn is_limited(self) -> bool {
        u16::from_le_bytes([self.high as u8, self.low as u8]) != 0
    }
}

/// The output stage; remembers what it put out.
#[derive(Clone, Debug)]
pub struct Output {
    config: Config,
    command: i32,
    active: ActiveLimits,
    /// There is such a limit.
    is_held: bool,
}

impl Output {
    /// A stage at zero.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            command: 0,
            active: ActiveLimits {
                high: false,
                low: false,
                slew: false,
            },
            is_held: false,
        }
    }

    /// Takes new limits; the output moves to them with the new slew.
    pub const fn reconfigure(&mut self, config: Config) {
        self.config = config;
    }

    /// What was put out last.
    #[must_use]
    pub const fn command(&self) -> Command {
        Command::from_bits(self.command)
    }

    /// The limits that held the last output back.
    #[must_use]
    pub const fn active_limits(&self) -> ActiveLimits {
        self.active
    }

    /// A limit held the last output back.
    #[inline]
    #[must_use]
    pub const fn is_held(&self) -> bool {
        self.is_held
    }

    /// Zero at once, without slew: the axis is off.
    pub const fn off(&mut self) -> Command {
        self.command = 0;
        self.is_held = false;
        self.active = ActiveLimits {
            high: false,
            low: false,
            slew: false,
        };
        Command::ZERO
    }

    /// Limits a demand, first in size, then in its change since the last tick.
    pub const fn step(&mut self, demand: Command) -> Command {
        let Config { limit, slew } = self.config;
        let demand = demand.to_bits();
        let in_range = bounded(demand, limit.wrapping_neg(), limit);
        // Where an end of the window saturates it is beyond any limit.
        let lowest = self.command.saturating_sub(slew);
        let highest = self.command.saturating_add(slew);
        let command = bounded(in_range, lowest, highest);
        self.command = command;
        if command != demand || self.is_held {
            self.note(demand, in_range);
        }
        Command::from_bits(command)
    }

    /// A limit holds the output back, or held the last one.
    #[cold]
    const fn note(&mut self, demand: i32, in_range: i32) {
        let command = self.command;
        self.is_held = command != demand;
        self.active = ActiveLimits {
            high: demand > command,
            low: demand < command,
            slew: in_range != command && command != demand,
        };
    }
}

const fn bounded(value: i32, low: i32, high: i32) -> i32 {
    if value < low {
        low
    } else if value > high {
        high
    } else {
        value
    }
}
