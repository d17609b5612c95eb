//! What to record and when.

use super::error::ScopeError;
use super::signals::Signals;
use super::trigger::Trigger;

/// What to record and when.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setup {
    /// What.
    pub signals: Signals,
    /// Ticks from sample to sample, 1 and more. The values are those of the sampled ticks, not means.
    pub every: u16,
    /// What it waits for.
    pub trigger: Trigger,
    /// Samples before that of the trigger, less than `samples`. A trigger that comes earlier is not put off: there are
    /// then fewer before it and more behind it.
    pub pre: u32,
    /// Samples in all.
    pub samples: u32,
}

impl Setup {
    /// Checks it for a memory of that many words.
    ///
    /// # Errors
    /// [`ScopeError`].
    pub const fn check(&self, words: usize) -> Result<(), ScopeError> {
        let Self {
            every,
            pre,
            samples,
            ..
        } = *self;
        if every == 0 {
            return Err(ScopeError::NoDecimation);
        }
        if samples == 0 {
            return Err(ScopeError::NoSamples);
        }
        let fit = Self::fit(&self.signals, words);
        if samples > fit {
            return Err(ScopeError::TooManySamples { samples, fit });
        }
        if pre >= samples {
            return Err(ScopeError::PreTooLong { pre, samples });
        }
        Ok(())
    }

    /// Samples of these signals that a memory of that many words holds.
    #[must_use]
    pub const fn fit(signals: &Signals, words: usize) -> u32 {
        match words.checked_div(signals.len()) {
            Some(fit) if fit <= u32::MAX as usize => fit as u32,
            Some(_) => u32::MAX,
            None => 0,
        }
    }
}
