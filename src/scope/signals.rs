//! A list of signals.

use super::error::ScopeError;
use super::signal::Signal;

/// Most signals that are recorded at once.
pub const MOST_SIGNALS: usize = 8;

/// One to [`MOST_SIGNALS`] signals, in the order in which a sample has them.
// Behind the last one the list is always the same: so lists can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signals {
    list: [Signal; MOST_SIGNALS],
    length: u8,
}

impl Signals {
    /// These signals; one may come twice.
    ///
    /// # Errors
    /// [`ScopeError`] for none and for more than [`MOST_SIGNALS`].
    pub fn new(signals: &[Signal]) -> Result<Self, ScopeError> {
        Self::collect(signals.iter().copied().map(Ok), signals.len())
    }

    /// The signals of these numbers.
    ///
    /// # Errors
    /// As [`Self::new`], and for a number that no signal has.
    pub fn from_numbers(numbers: &[u8]) -> Result<Self, ScopeError> {
        let signal = |number: &u8| {
            Signal::from_number(*number).ok_or(ScopeError::UnknownSignal { number: *number })
        };
        Self::collect(numbers.iter().map(signal), numbers.len())
    }

    fn collect(
        signals: impl Iterator<Item = Result<Signal, ScopeError>>,
        given: usize,
    ) -> Result<Self, ScopeError> {
        if given == 0 {
            return Err(ScopeError::NoSignal);
        }
        if given > MOST_SIGNALS {
            return Err(ScopeError::TooManySignals { given });
        }
        let mut list = [Signal::Tick; MOST_SIGNALS];
        for (place, signal) in list.iter_mut().zip(signals) {
            *place = signal?;
        }
        Ok(Self {
            list,
            length: given as u8,
        })
    }

    /// How many: words of a sample.
    #[must_use]
    #[inline]
    #[expect(clippy::len_without_is_empty, reason = "there is one at least")]
    pub const fn len(&self) -> usize {
        self.length as usize
    }

    /// They, in order.
    #[must_use]
    #[inline]
    pub fn as_slice(&self) -> &[Signal] {
        self.list.get(..self.len()).unwrap_or(&self.list)
    }
}
