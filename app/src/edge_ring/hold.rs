//! Whether a ring is long enough to be borrowed from for a tick.

use core::fmt;

/// Ticks at the highest rate of edges that a ring holds at least.
pub const LEAST_TICKS: f64 = 4.0;

/// A ring that is too short for what may come in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HoldError {
    /// It holds less than four ticks.
    Short {
        /// Its words.
        words: usize,
        /// Words that it needs.
        needed: f64,
    },
    /// The inputs' filter lets through more than half of it in a tick.
    Open {
        /// Its words.
        words: usize,
        /// Edges in a tick that the filter passes.
        passed: f64,
    },
}

impl fmt::Display for HoldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Short { words, needed } => write!(
                f,
                "the ring of {words} edge times holds less than {LEAST_TICKS} ticks at the highest edge rate, which are \
                 {needed:.0}: raise tick_hz or lower the highest edge rate"
            ),
            Self::Open { words, passed } => write!(
                f,
                "the input filter passes up to {passed:.0} edges in a tick, more than half the ring of {words} edge \
                 times: raise tick_hz or lower the highest edge rate, which lengthens the filter"
            ),
        }
    }
}

impl core::error::Error for HoldError {}

/// Checks a ring of `words` at `tick_hz`, with edges of A and B at `edge_hz` at most and an input filter that passes
/// `filter_hz` of them whatever comes in ([`crate::input_filter::InputFilter::passed_hz`]).
///
/// # Errors
/// [`HoldError`] if it is shorter than four ticks of `edge_hz`, or half of it shorter than one of `filter_hz`.
pub fn hold(words: usize, tick_hz: f64, edge_hz: f64, filter_hz: f64) -> Result<(), HoldError> {
    let needed = LEAST_TICKS * edge_hz / tick_hz;
    // What is no number is in no range.
    if !(0.0..=words as f64).contains(&needed) {
        return Err(HoldError::Short { words, needed });
    }
    let passed = filter_hz / tick_hz;
    if !(0.0..words as f64 / 2.0).contains(&passed) {
        return Err(HoldError::Open { words, passed });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_holds_four_ticks_and_half_of_it_what_the_filter_passes() {
        assert_eq!(hold(8192, 1000.0, 1.2e6, 2.625e6), Ok(()));
        assert_eq!(
            hold(4096, 1000.0, 1.2e6, 1e6),
            Err(HoldError::Short {
                words: 4096,
                needed: 4800.0
            })
        );
        assert_eq!(
            hold(8192, 1000.0, 1.2e6, 5.25e6),
            Err(HoldError::Open {
                words: 8192,
                passed: 5250.0
            })
        );
        assert!(hold(8192, f64::NAN, 1.2e6, 1e6).is_err());
    }
}
