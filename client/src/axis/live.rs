//! Signals of an axis as they come, made whole.

use std::time::Duration;

use leadscrew::scope::Signal;

use super::Axis;
use crate::error::Error;
use crate::recording::{Builder, Recording};
use crate::scale::Scale;

/// A live view of signals: begun by [`Axis::live`], fed by [`Axis::listen`].
///
/// A stream has the low words of positions alone. They are made whole from where the axis is when it begins, which is
/// exact unless a position moves by 32 768 d between two samples, as it does where an origin is set.
#[derive(Debug)]
pub struct Live {
    builder: Builder,
}

impl Live {
    /// What came so far.
    #[must_use]
    pub const fn recording(&self) -> &Recording {
        &self.builder.recording
    }

    /// The same to be changed, as whoever shows the newest part of it drops the oldest.
    pub const fn recording_mut(&mut self) -> &mut Recording {
        &mut self.builder.recording
    }

    /// What came.
    #[must_use]
    pub fn into_recording(self) -> Recording {
        self.builder.recording
    }
}

impl Axis {
    /// Begins a live view: a sample of 1 to 8 signals in every `every` ticks, until [`Self::end_live`].
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn live(&mut self, signals: &[Signal], every: u16) -> Result<Live, Error> {
        let scale = self.scale()?;
        let bases = self.whole_values(signals, scale)?;
        let numbers: Vec<u8> = signals.iter().map(|&signal| signal as u8).collect();
        // Those of a stream before this one.
        self.drop_samples();
        self.stream(every, &numbers)?;
        let recording = Recording::new(scale, signals, every);
        Ok(Live {
            builder: Builder::new(recording, &bases),
        })
    }

    /// Takes the samples that come within so long on the line's clock, and those that came before. The lease is kept.
    ///
    /// # Errors
    /// As of [`Self::wait`].
    pub fn listen(&mut self, live: &mut Live, time: Duration) -> Result<(), Error> {
        let until = self.connection.now().saturating_add(time);
        loop {
            while let Some((tick, words)) = self.connection.take_sample() {
                live.builder.push(tick, &words);
            }
            if self.connection.now() >= until {
                return Ok(());
            }
            self.connection.go_on()?;
        }
    }

    /// Ends the samples; what was on its way is taken first.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn end_live(&mut self, live: &mut Live) -> Result<(), Error> {
        self.stream(0, &[])?;
        self.listen(live, Duration::ZERO)
    }

    fn drop_samples(&mut self) {
        while self.connection.take_sample().is_some() {}
    }

    /// Where the signals are now, as far as low words need it.
    fn whole_values(&mut self, signals: &[Signal], scale: Scale) -> Result<Vec<i64>, Error> {
        let status = self.status()?;
        let count = self.experiment()?.count;
        let value = |&signal: &Signal| {
            let bits = |mm| scale.of(signal).bits(mm);
            match signal {
                Signal::ReportedPosition => bits(status.position_mm),
                Signal::CommandedPosition => bits(status.setpoint_mm),
                Signal::Count | Signal::Position | Signal::SetpointPosition => {
                    count << signal.frac()
                }
                // The others begin at 0.
                _ => 0,
            }
        };
        Ok(signals.iter().map(value).collect())
    }
}
