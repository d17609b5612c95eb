//! A list of signals.

use super::error::ScopeError;
use super::signal::{Kind, Signal};

/// Most signals that are recorded at once.
pub const MOST_SIGNALS: usize = 8;

/// One to [`MOST_SIGNALS`] signals, in the order in which a sample has them.
#[derive(Clone, Copy, Debug)]
pub struct Signals {
    list: [Signal; MOST_SIGNALS],
    length: u8,
    /// Bit n: signal n is [`Kind::Wide`].
    wide: u8,
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
        let mut wide = 0_u8;
        for ((place, signal), bit) in list.iter_mut().zip(signals).zip(0_u32..) {
            *place = signal?;
            if matches!(place.kind(), Kind::Wide) {
                wide |= 1_u8.wrapping_shl(bit);
            }
        }
        Ok(Self {
            list,
            length: given as u8,
            wide,
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

    /// Bit n: signal n is [`Kind::Wide`].
    #[inline]
    pub(super) const fn wide(&self) -> u8 {
        self.wide
    }
}

impl PartialEq for Signals {
    fn eq(&self, other: &Self) -> bool {
        self.as_slice() == other.as_slice()
    }
}

impl Eq for Signals {}
