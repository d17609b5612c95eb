//! Opening a session.

use std::time::Duration;

use leadscrew::protocol::VERSION;
use leadscrew::protocol::client::Client;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;

use super::{Connection, Kept, Lease, Said};
use crate::error::Error;
use crate::identity::Identity;
use crate::line::Line;
use crate::options::Options;

/// Hellos with another number each, before an axis that takes none is given up.
const HELLOS: u32 = 4;

impl Connection {
    /// Opens a session over a line. One that another tool had open is ended by it, and its lease with it.
    ///
    /// # Errors
    /// [`Error::Lost`] if nobody answers, [`Error::ProtocolVersion`], [`Error::Line`].
    pub fn open(line: Box<dyn Line>, options: Options) -> Result<Self, Error> {
        let nonce = options.first_nonce();
        let mut connection = Self {
            line,
            options,
            client: Client::new(),
            identity: Identity::default(),
            nonce,
            now: Duration::ZERO,
            seen: 0,
            lease: Lease::Free,
            is_stopping: false,
            records: Kept::default(),
            samples: Kept::default(),
            frame: Vec::new(),
            received: Vec::new(),
        };
        connection.hello()?;
        Ok(connection)
    }

    /// Opens another session over the same line, as after [`Error::Lost`]: the axis then stands, or comes to stand, with
    /// its drive off, if this tool moved it.
    ///
    /// # Errors
    /// As of [`Self::open`].
    pub fn reconnect(&mut self) -> Result<(), Error> {
        self.nonce = self.nonce.wrapping_add(1);
        // What was enabled under a lease of the session before stops with it.
        if self.lease.is_held() {
            self.lease = Lease::Lapsed { is_told: true };
        }
        self.records = Kept::default();
        self.samples = Kept::default();
        self.hello()
    }

    fn hello(&mut self) -> Result<(), Error> {
        for _ in 0..HELLOS {
            let request = Request::Hello {
                protocol: VERSION,
                nonce: self.nonce,
            };
            match self.transact(&request, identity)? {
                Said::Asked((identity, tick)) if identity.protocol == VERSION => {
                    self.identity = identity;
                    self.seen = tick;
                    if self.is_fresh()? {
                        return Ok(());
                    }
                    self.nonce = self.nonce.wrapping_add(1);
                }
                Said::Asked((identity, _)) => {
                    return Err(Error::ProtocolVersion {
                        axis: identity.protocol,
                        firmware: identity.firmware,
                    });
                }
                // The number was that of a session before.
                Said::Refused(number) if number == Refusal::Late as u16 => {
                    self.nonce = self.nonce.wrapping_add(1);
                }
                Said::Refused(number) => return Err(self.refused(&request, number)),
                Said::Other => break,
            }
        }
        Err(Error::Unexpected {
            asked: "Hello".to_owned(),
        })
    }

    /// False for a session that was open already, of a tool that began with the same number: its requests are ahead.
    fn is_fresh(&mut self) -> Result<bool, Error> {
        let said = self.transact(&Request::Status {}, |_| Some(()))?;
        Ok(!matches!(said, Said::Refused(number) if number == Refusal::Late as u16))
    }
}

fn identity(reply: &Reply<'_>) -> Option<(Identity, u32)> {
    let Reply::Hello {
        protocol,
        tick_hz,
        lease_ticks,
        tick,
        capabilities,
        work_memory,
        firmware,
        build,
        board,
        ..
    } = *reply
    else {
        return None;
    };
    let identity = Identity {
        protocol,
        firmware: firmware.to_owned(),
        build: build.to_owned(),
        board: board.to_owned(),
        tick_hz,
        lease_ticks,
        capabilities,
        work_memory,
    };
    Some((identity, tick))
}
