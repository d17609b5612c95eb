//! Records of ticks as they come.

use std::time::Duration;

use leadscrew::protocol::request::Request;
use leadscrew::telemetry::Record;

use super::Axis;
use crate::connection::{Connection, Sample};
use crate::error::Error;

impl Axis {
    /// Asks for a record in every `every` ticks; 0 ends them. They end with the session, too. Those that came while
    /// something else was done are kept, 65 536 of them.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn subscribe(&mut self, every: u16) -> Result<(), Error> {
        self.connection
            .order(&Request::Subscribe { every })
            .map(drop)
    }

    /// Asks for samples of signals in every `every` ticks, 8 signals at most by their numbers; 0 ticks end them.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn stream(&mut self, every: u16, signals: &[u8]) -> Result<(), Error> {
        let request = Request::Stream { every, signals };
        self.connection.order(&request).map(drop)
    }

    /// The samples, oldest first; waited for as of [`Self::records`].
    pub const fn samples(&mut self, patience: Duration) -> Samples<'_> {
        Samples {
            axis: self,
            patience,
        }
    }

    /// Waits for what `take` finds.
    fn next_of<T>(
        &mut self,
        patience: Duration,
        take: fn(&mut Connection) -> Option<T>,
    ) -> Option<Result<T, Error>> {
        let connection = &mut self.connection;
        let until = connection.now().saturating_add(patience);
        loop {
            if let Some(one) = take(connection) {
                return Some(Ok(one));
            }
            if connection.now() >= until {
                return None;
            }
            if let Err(error) = connection.go_on() {
                return Some(Err(error));
            }
        }
    }

    /// The records, oldest first, in the units of the axis; each is waited for, on the line's clock, for `patience`.
    /// The lease is kept meanwhile.
    pub const fn records(&mut self, patience: Duration) -> Records<'_> {
        Records {
            axis: self,
            patience,
        }
    }
}

/// Records of an axis. It ends when none comes within the patience.
#[derive(Debug)]
pub struct Records<'a> {
    axis: &'a mut Axis,
    patience: Duration,
}

impl Records<'_> {
    /// Records of this session that were lost so far: on the line, or because nobody took them in time.
    #[must_use]
    pub const fn lost(&self) -> u32 {
        self.axis.connection.records_lost()
    }
}

impl Iterator for Records<'_> {
    type Item = Result<Record, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        self.axis.next_of(self.patience, Connection::take_record)
    }
}

/// Samples of signals of an axis. It ends when none comes within the patience.
#[derive(Debug)]
pub struct Samples<'a> {
    axis: &'a mut Axis,
    patience: Duration,
}

impl Samples<'_> {
    /// Frames of samples that were lost on the line so far, and samples that nobody took in time.
    #[must_use]
    pub const fn lost(&self) -> u32 {
        self.axis.connection.samples_lost()
    }
}

impl Iterator for Samples<'_> {
    type Item = Result<Sample, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        self.axis.next_of(self.patience, Connection::take_sample)
    }
}
