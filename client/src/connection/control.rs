//! The control lease, and orders under it.

use std::time::Duration;

use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;

use super::{Connection, Said};
use crate::error::Error;

/// How long a goodbye is tried.
const GOODBYE: Duration = Duration::from_millis(100);

/// The control lease as the tool knows it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Lease {
    /// Not taken.
    #[default]
    Free,
    /// Taken, and renewed last at this time of the line.
    Held { renewed: Duration },
    /// It was taken and has lapsed: the axis has stopped.
    Lapsed {
        /// Whoever waits was told of it.
        is_told: bool,
    },
}

impl Lease {
    pub(super) const fn is_held(&self) -> bool {
        matches!(self, Self::Held { .. })
    }
}

impl Connection {
    /// True while this session holds the control lease, as far as it knows.
    #[must_use]
    pub const fn holds_lease(&self) -> bool {
        self.lease.is_held()
    }

    /// Takes the control lease, or renews it. A session before this one may hold it for a tenth of a second more, which
    /// is waited for.
    ///
    /// # Errors
    /// [`Error::Refused`] with [`Refusal::LeaseHeld`] where another one holds it for longer; those of a lost axis.
    pub fn take_lease(&mut self) -> Result<(), Error> {
        let lease = Duration::from_millis(150);
        let until = self
            .now
            .saturating_add(lease.max(self.options.timing.patience));
        loop {
            let sent = self.now;
            match self.transact(&Request::TakeLease {}, acknowledged)? {
                Said::Asked(_) => {
                    self.lease = Lease::Held { renewed: sent };
                    return Ok(());
                }
                Said::Refused(number)
                    if number == Refusal::LeaseHeld as u16 && self.now < until =>
                {
                    self.idle()?;
                }
                Said::Refused(number) => return Err(self.refused(&Request::TakeLease {}, number)),
                Said::Other => return Err(unexpected("TakeLease")),
            }
        }
    }

    /// Gives the control lease back. An enabled axis stays enabled.
    ///
    /// # Errors
    /// [`Error::Refused`] with [`Refusal::StillMoving`] while the axis moves; [`Error::LeaseLapsed`]; those of a lost axis.
    pub fn release_lease(&mut self) -> Result<(), Error> {
        if !self.lease.is_held() {
            return Ok(());
        }
        match self.transact(&Request::ReleaseLease {}, acknowledged)? {
            Said::Asked(_) => {
                self.lease = Lease::Free;
                Ok(())
            }
            Said::Refused(number) => Err(self.refused(&Request::ReleaseLease {}, number)),
            Said::Other => Err(unexpected("ReleaseLease")),
        }
    }

    /// The axis is off, and knows of no lease any more.
    pub(crate) const fn forget_lease(&mut self) {
        self.lease = Lease::Free;
    }

    pub(super) fn release_shortly(&mut self) -> Result<(), Error> {
        self.options.timing.lost = self.options.timing.lost.min(GOODBYE);
        self.release_lease()
    }

    /// Renews the lease if it is held and its time has come. One that has lapsed is only noted: asking how an axis stands
    /// needs none.
    pub(super) fn renew_if_due(&mut self) -> Result<(), Error> {
        let Lease::Held { renewed } = self.lease else {
            return Ok(());
        };
        if self.now.saturating_sub(renewed) < self.options.timing.renew {
            return Ok(());
        }
        // A refusal of a tick that is too old tells a new one.
        for _ in 0..2 {
            let sent = self.now;
            let request = Request::RenewLease { seen: self.seen };
            match self.transact(&request, acknowledged)? {
                Said::Asked(_) => {
                    self.lease = Lease::Held { renewed: sent };
                    return Ok(());
                }
                Said::Refused(number) if number == Refusal::StaleRenewal as u16 => {}
                Said::Refused(number) => {
                    return match self.refused(&request, number) {
                        Error::LeaseLapsed => Ok(()),
                        error => Err(error),
                    };
                }
                Said::Other => return Err(unexpected("RenewLease")),
            }
        }
        Ok(())
    }

    /// The lease for an order. What begins anew takes one whatever was before; what goes on needs to know if the axis has
    /// stopped in between.
    fn lease_for(&mut self, request: &Request<'_>) -> Result<(), Error> {
        self.renew_if_due()?;
        let goes_on = matches!(
            request,
            Request::Home {}
                | Request::Move { .. }
                | Request::Jog { .. }
                | Request::Resume {}
                | Request::Override { .. }
                | Request::Select { .. }
                | Request::Engage { .. }
                | Request::StartExperiment { .. }
                | Request::LearnRun { .. }
        );
        match self.lease {
            Lease::Held { .. } => Ok(()),
            Lease::Lapsed { .. } if goes_on => Err(Error::LeaseLapsed),
            Lease::Lapsed { .. } | Lease::Free => self.take_lease(),
        }
    }

    /// Gives an order, under the control lease if it needs one; gives the tick of its acknowledgement. One that is refused
    /// only for the moment is given again for a short while.
    ///
    /// # Errors
    /// [`Error::Refused`], [`Error::LeaseLapsed`], those of a lost axis; [`Error::Interrupted`] instead of an order that
    /// needs the lease.
    pub fn order(&mut self, request: &Request<'_>) -> Result<u32, Error> {
        let until = self.now.saturating_add(self.options.timing.patience);
        loop {
            if request.needs_lease() {
                self.check_interrupted()?;
                self.lease_for(request)?;
            } else {
                self.renew_if_due()?;
            }
            match self.transact(request, acknowledged)? {
                Said::Asked(tick) => return Ok(tick),
                Said::Refused(number) if is_of_the_moment(number) && self.now < until => {
                    self.idle()?;
                }
                Said::Refused(number) => return Err(self.refused(request, number)),
                Said::Other => return Err(unexpected(request.name())),
            }
        }
    }
}

fn acknowledged(reply: &Reply<'_>) -> Option<u32> {
    match *reply {
        Reply::Ack { tick } => Some(tick),
        _ => None,
    }
}

fn unexpected(asked: &str) -> Error {
    Error::Unexpected {
        asked: asked.to_owned(),
    }
}

/// Refusals that are over in a few ticks. What was refused was not done, so it may be asked anew.
fn is_of_the_moment(number: u16) -> bool {
    matches!(
        Refusal::from_number(number),
        Some(Refusal::QueueFull | Refusal::TooLate | Refusal::Busy)
    )
}
