//! What the scope of an axis recorded, whole and in the units of people.

use std::time::Duration;

use leadscrew::scope::Interruption;

use super::{Axis, ScopeStatus};
use crate::error::Error;
use crate::recording::{Builder, Recording};
use crate::scale::Scale;

impl Axis {
    /// Scale of the axis's signals.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn scale(&mut self) -> Result<Scale, Error> {
        let mut number = |name: &str| {
            let value = self.parameter(name)?.number();
            value.ok_or_else(|| Error::Unexpected {
                asked: name.to_owned(),
            })
        };
        Ok(Scale {
            tick_hz: number("tick_hz")?,
            counts_per_mm: number("motion.counts_per_mm")?,
        })
    }

    /// Samples of so many signals that the work memory of the axis holds.
    #[must_use]
    pub fn scope_room(&self, signals: usize) -> u32 {
        let words = self.identity().work_memory as usize / 4;
        u32::try_from(words / signals.max(1)).unwrap_or(u32::MAX)
    }

    /// Waits until the scope is over, for so long on the line's clock; `None` if it is not by then. The lease is kept.
    ///
    /// # Errors
    /// As of [`Self::wait`].
    pub fn wait_for_scope(&mut self, patience: Duration) -> Result<Option<ScopeStatus>, Error> {
        let until = self.connection.now().saturating_add(patience);
        loop {
            let scope = self.scope()?;
            if scope.is_over() {
                return Ok(Some(scope));
            }
            if self.connection.now() >= until {
                return Ok(None);
            }
            self.connection.wait_a_look()?;
        }
    }

    /// Reads all that a scope recorded that is over.
    ///
    /// # Errors
    /// As of [`Self::read_scope`].
    pub fn read_recording(&mut self, scope: &ScopeStatus) -> Result<Recording, Error> {
        let scale = self.scale()?;
        let samples = self.read_scope(scope)?;
        Ok(recording(scope, scale, &samples))
    }
}

fn recording(scope: &ScopeStatus, scale: Scale, samples: &[Vec<i32>]) -> Recording {
    let mut recording = Recording::new(scale, &scope.signals, scope.every);
    recording.is_torn = scope.is_torn;
    // One that was stopped between the trigger and its sample tells one behind the last.
    let last = samples.len().saturating_sub(1);
    recording.trigger = scope.trigger.map(|trigger| (trigger as usize).min(last));
    let mut builder = Builder::new(recording, &scope.bases);
    let mut tick = scope.tick;
    for (sample, words) in (0..).zip(samples) {
        let here = scope.interruptions.iter();
        for interruption in here.filter(|one| one.sample == sample) {
            match interruption.what {
                Interruption::Missed { ticks } => tick = tick.wrapping_add(ticks),
                Interruption::Jump { signal, to, .. } => builder.jump(signal.into(), to),
            }
        }
        builder.push(tick, words);
        tick = tick.wrapping_add(scope.every.into());
    }
    builder.recording
}
