//! Why a scope cannot be set up so, and what to do.

use core::fmt;

use super::signals::MOST_SIGNALS;

/// What is wrong with a setup. The text says what to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScopeError {
    /// No signal is to be recorded.
    NoSignal,
    /// More than [`MOST_SIGNALS`].
    TooManySignals {
        /// How many were asked for.
        given: usize,
    },
    /// There is no signal of that number.
    UnknownSignal {
        /// The number.
        number: u8,
    },
    /// A sample every 0 ticks.
    NoDecimation,
    /// No sample is to be recorded.
    NoSamples,
    /// More samples than the memory holds.
    TooManySamples {
        /// How many were asked for.
        samples: u32,
        /// How many fit, of so many signals.
        fit: u32,
    },
    /// The part before the trigger leaves no room for the sample of the trigger.
    PreTooLong {
        /// Samples asked for before the trigger.
        pre: u32,
        /// Samples in all.
        samples: u32,
    },
}

impl fmt::Display for ScopeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoSignal => write!(f, "no signal to record: name 1 to {MOST_SIGNALS}"),
            Self::TooManySignals { given } => {
                write!(f, "{given} signals to record: name at most {MOST_SIGNALS}")
            }
            Self::UnknownSignal { number } => write!(
                f,
                "there is no signal of number {number}: docs/scope.md lists them; a newer tool may know more than the axis"
            ),
            Self::NoDecimation => {
                f.write_str("a sample every 0 ticks: record every tick (1), or every n-th")
            }
            Self::NoSamples => f.write_str("no samples to record: ask for 1 at least"),
            Self::TooManySamples { samples, fit } => write!(
                f,
                "{samples} samples do not fit, {fit} do: record fewer samples or signals, or every n-th tick"
            ),
            Self::PreTooLong { pre, samples } => write!(
                f,
                "{pre} samples before the trigger of {samples} in all: leave at least one for the trigger"
            ),
        }
    }
}

impl core::error::Error for ScopeError {}
