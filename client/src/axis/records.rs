//! Records of ticks as they come.

use std::time::Duration;

use leadscrew::protocol::request::Request;
use leadscrew::telemetry::Record;

use super::Axis;
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
    pub fn lost(&self) -> u32 {
        self.axis.connection.records_lost()
    }
}

impl Iterator for Records<'_> {
    type Item = Result<Record, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let connection = &mut self.axis.connection;
        let until = connection.now() + self.patience;
        loop {
            if let Some(record) = connection.take_record() {
                return Some(Ok(record));
            }
            if connection.now() >= until {
                return None;
            }
            if let Err(error) = connection.go_on() {
                return Some(Err(error));
            }
        }
    }
}
