//! An axis in the units of people.

mod experiment;
mod learning;
mod live;
mod motion;

mod parameters;
mod probing;
mod recorded;
mod records;
mod scope;
mod store;

pub use experiment::{ExperimentPhase, ExperimentStatus};
pub use learning::{Learned, LearningPhase, LearningStatus};
pub use live::Live;
pub use parameters::{Parameter, Value};
pub use probing::{ProbeStatus, Touch};
pub use records::{Records, Samples};
pub use scope::{ScopePhase, ScopeStatus};
pub use store::{FaultPage, Kind, LastReset, Stored, TickCounters};

use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use leadscrew::supervisor::State;

use crate::connection::Connection;
use crate::error::Error;
use crate::identity::Identity;
use crate::line::Line;
use crate::options::Options;
use crate::status::{LinkStatistics, Losses, Status};

/// An axis that a tool is connected to.
///
/// Everything here blocks until it is done, keeps the control lease meanwhile, and ends with an error if the axis
/// does not do it. Errors that all of it may give: [`Error::Lost`], [`Error::Line`], [`Error::SessionTaken`] and
/// [`Error::Restarted`] of an axis that cannot be reached any more; [`Error::Refused`]; and where it waits or moves
/// [`Error::LeaseLapsed`], [`Error::Faulted`] and [`Error::Interrupted`].
///
/// Between calls nobody keeps the lease: whoever thinks for longer than a tenth of a second while the axis is enabled does
/// it in [`Self::wait`] or [`Self::keep_alive_while`]. When it is dropped the lease is given back if the axis stands, which
/// stays enabled; if it moves it makes a controlled stop.
#[derive(Debug)]
pub struct Axis {
    connection: Connection,
    /// When the last order was acknowledged, axis tick.
    ordered: u32,
}

impl Axis {
    /// Connects over a line: [`Port::open`](crate::Port::open) makes those of serial ports and TCP. A tool that was
    /// connected before is cut off.
    ///
    /// # Errors
    /// [`Error::Lost`] if nobody answers, [`Error::ProtocolVersion`], [`Error::Line`].
    pub fn open(line: impl Line + 'static, options: Options) -> Result<Self, Error> {
        Ok(Self::new(Connection::open(Box::new(line), options)?))
    }

    /// The axis at the other end of a connection.
    #[must_use]
    pub const fn new(connection: Connection) -> Self {
        let ordered = connection.seen();
        Self {
            connection,
            ordered,
        }
    }

    /// The connection, for requests that have no function here.
    pub const fn connection(&mut self) -> &mut Connection {
        &mut self.connection
    }

    /// Opens a new session over the same line, as after [`Error::Lost`].
    ///
    /// # Errors
    /// As of [`Self::open`].
    pub fn reconnect(&mut self) -> Result<(), Error> {
        self.connection.reconnect()?;
        self.ordered = self.connection.seen();
        Ok(())
    }

    /// Gives the control lease back and ends; an enabled axis stays enabled.
    ///
    /// # Errors
    /// [`Error::Refused`] while it moves, [`Error::LeaseLapsed`].
    pub fn close(mut self) -> Result<(), Error> {
        self.connection.release_lease()
    }

    /// What the axis said of itself.
    #[must_use]
    pub const fn identity(&self) -> &Identity {
        self.connection.identity()
    }

    /// How it stands.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn status(&mut self) -> Result<Status, Error> {
        self.connection.query(&Request::Status {}, Status::of)
    }

    /// What was dropped of the link.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn link_statistics(&mut self) -> Result<LinkStatistics, Error> {
        let axis = self.connection.query(&Request::Link {}, Losses::of_axis)?;
        let dropped = self.connection.dropped();
        let here = Losses {
            torn: dropped.torn,
            too_long: dropped.too_long,
            too_short: dropped.too_short,
            checksum: dropped.checksum,
            unknown: dropped.unknown,
            late: dropped.late,
            records_lost: self.connection.records_lost(),
        };
        Ok(LinkStatistics { axis, here })
    }

    /// Puts the axis under control and waits until it is ready.
    ///
    /// # Errors
    /// [`Error::Faulted`], [`Error::NotReached`] if it is not ready in time.
    pub fn enable(&mut self) -> Result<Status, Error> {
        self.order(&Request::Enable {})?;
        let advice =
            "Look at the drive's ready line and at the brake, and at the fault if there is one";
        self.wait_for("not ready", advice, |status| match status.state() {
            Some(State::Ready | State::Moving) => Ok(true),
            _ => Ok(false),
        })
    }

    /// Takes the axis out of control: a controlled stop, brake, drive off; waits until it is off. Needs no lease.
    ///
    /// # Errors
    /// [`Error::NotReached`] if it is not off in time.
    pub fn disable(&mut self) -> Result<Status, Error> {
        self.order(&Request::Disable {})?;
        let advice = "Watch it; if it does not stop use the emergency stop";
        let off = |status: &Status| {
            let at_rest = matches!(status.state(), Some(State::Disabled | State::Fault));
            at_rest && !status.is_enabled
        };
        self.wait_for_end("not off", advice, off)
    }

    /// Clears the fault, and waits until it is gone.
    ///
    /// # Errors
    /// [`Error::Refused`] with what is in the way.
    pub fn clear_fault(&mut self) -> Result<(), Error> {
        self.order(&Request::ClearFault {})?;
        let advice = "Read the fault and remove its cause";
        self.wait_for_end("the fault is not gone", advice, |status| {
            status.fault_number == 0
        })
        .map(drop)
    }

    /// Forgets the warnings.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn clear_warnings(&mut self) -> Result<(), Error> {
        self.order(&Request::ClearWarnings {})
    }

    /// Gives an order, under the control lease if it needs one.
    fn order(&mut self, request: &Request<'_>) -> Result<(), Error> {
        self.ordered = self.connection.order(request)?;
        Ok(())
    }

    /// Waits until `is_done`, which looks at the axis after the last order could show; a fault ends it, and a lease that
    /// lapses.
    fn wait_for(
        &mut self,
        what: &'static str,
        advice: &'static str,
        mut is_done: impl FnMut(&Status) -> Result<bool, Error>,
    ) -> Result<Status, Error> {
        self.look_until(what, advice, |connection, status| {
            if status.fault_number != 0 {
                // Told when the axis stands.
                return match status.state() {
                    Some(State::Stopping | State::Moving) => Ok(false),
                    _ => Err(Error::Faulted(status.fault_number)),
                };
            }
            connection.check_lapse()?;
            is_done(status)
        })
    }

    /// The same for what comes to its end by itself.
    fn wait_for_end(
        &mut self,
        what: &'static str,
        advice: &'static str,
        is_done: impl Fn(&Status) -> bool,
    ) -> Result<Status, Error> {
        self.look_until(what, advice, |_, status| Ok(is_done(status)))
    }

    /// Looks at the axis until `is_done`. It gives up when for the time to settle nothing has moved.
    fn look_until(
        &mut self,
        what: &'static str,
        advice: &'static str,
        mut is_done: impl FnMut(&mut Connection, &Status) -> Result<bool, Error>,
    ) -> Result<Status, Error> {
        let mut begin = self.connection.now();
        loop {
            let status = self.status()?;
            let shows = self.connection.has_begun(status.tick, self.ordered);
            if shows && is_done(&mut self.connection, &status)? {
                return Ok(status);
            }
            // A long move is no failure, nor is a feed hold.
            if status.is_moving || status.is_held {
                begin = self.connection.now();
            }
            let after = self.connection.now().saturating_sub(begin);
            if after >= self.connection.options().timing.settle {
                return Err(Error::NotReached {
                    what,
                    after,
                    now: status.state_text().to_owned(),
                    advice,
                });
            }
            self.connection.wait_a_look()?;
        }
    }

    /// Asks for a reply that `take` knows.
    fn query<T>(
        &mut self,
        request: &Request<'_>,
        take: impl FnMut(&Reply<'_>) -> Option<T>,
    ) -> Result<T, Error> {
        self.connection.query(request, take)
    }
}
