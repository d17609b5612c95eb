//! What an axis keeps: the fault that stopped it, what its tick counted, what is saved in its flash.

use std::time::Duration;

use leadscrew::protocol::frame::checksum;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use leadscrew::supervisor::Fault;

use super::Axis;
use crate::error::Error;

/// Bytes written in a request: they fit a frame with all else, and are whole words.
const CHUNK: usize = 200;
/// Time after which an axis that restarts does not answer any more.
const GONE: Duration = Duration::from_millis(100);
/// Longest thing that is read back: more than any board has flash for it.
const MOST: u32 = 1 << 20;

/// A fault with its context, in d (counts of the encoder).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultPage {
    /// Tick in which it was found.
    pub tick: u32,
    /// Its number: [`Self::fault`].
    pub fault_number: u8,
    /// Number of the state before.
    pub state_number: u8,
    /// What was seen, in the unit that the table of faults states.
    pub value: f64,
    /// What is allowed, in the same unit.
    pub limit: f64,
    /// Bit n: the fault of number n came later.
    pub later: u32,
    /// Where the axis was by the encoder, d.
    pub position_d: f64,
    /// How fast it was, d/tick.
    pub velocity_d_per_tick: f64,
    /// Where it should have been, d.
    pub setpoint_d: f64,
    /// How fast it should have been, d/tick.
    pub setpoint_d_per_tick: f64,
    /// Setpoint less position, d.
    pub following_error_d: f64,
    /// What was put out, as a share of full command.
    pub command: f64,
}

impl FaultPage {
    /// The fault; `None` for one of a later version.
    #[must_use]
    pub const fn fault(&self) -> Option<Fault> {
        Fault::from_number(self.fault_number)
    }

    fn of(reply: &Reply<'_>) -> Option<Self> {
        let Reply::Fault {
            tick,
            fault,
            state,
            value,
            limit,
            later,
            position,
            velocity,
            setpoint_position,
            setpoint_velocity,
            following_error,
            command,
        } = *reply
        else {
            return None;
        };
        let q = |bits: i32| 2_f64.powi(-bits);
        Some(Self {
            tick,
            fault_number: fault,
            state_number: state,
            value: value as f64 * q(16),
            limit: limit as f64 * q(16),
            later,
            position_d: position as f64 * q(16),
            velocity_d_per_tick: f64::from(velocity) * q(20),
            setpoint_d: setpoint_position as f64 * q(16),
            setpoint_d_per_tick: f64::from(setpoint_velocity) * q(20),
            following_error_d: f64::from(following_error) * q(16),
            command: f64::from(command) * q(30),
        })
    }
}

/// What the tick counted since the axis was switched on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TickCounters {
    /// Ticks.
    pub ticks: u32,
    /// Ticks that did not run, or whose inputs came late.
    pub late: u32,
    /// Ticks that took too long.
    pub overlong: u32,
    /// Records that found the queue to the link full.
    pub lost_records: u32,
    /// Latest start of a tick, clocks of its timer.
    pub worst_start: u32,
    /// Latest end of a tick, clocks of its timer.
    pub worst_end: u32,
    /// Indexes of the encoder; wraps.
    pub indexes: u32,
    /// Count at the last index.
    pub index_count: i64,
    /// Counts from the index before it, along the way that was gone.
    pub index_distance: i64,
}

impl TickCounters {
    const fn of(reply: &Reply<'_>) -> Option<Self> {
        match *reply {
            Reply::Counters {
                ticks,
                late,
                overlong,
                lost_records,
                worst_start,
                worst_end,
                indexes,
                index_count,
                index_distance,
            } => Some(Self {
                ticks,
                late,
                overlong,
                lost_records,
                worst_start,
                worst_end,
                indexes,
                index_count,
                index_distance,
            }),
            _ => None,
        }
    }
}

/// Why the firmware was last started anew without being asked to, and how often since the power came.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LastReset {
    /// 0 it was not, 1 panic, 2 hard fault, 3 watchdog, 4 watchdog after ticks that ended too late one after another, 5 the
    /// stack reached its end.
    pub reason: u8,
    /// Such starts since the power came.
    pub resets: u32,
    /// Of a panic the line, of a hard fault the address of the instruction, of late ticks the first one.
    pub place: u32,
    /// Of a panic the FNV-1a of the file's whole path, of a hard fault where it was called from.
    pub origin: u32,
    /// Of a hard fault CFSR, HFSR and the address of the access.
    pub status: [u32; 3],
    /// Of a panic the end of the file's path.
    pub file: String,
}

impl LastReset {
    fn of(reply: &Reply<'_>) -> Option<Self> {
        match *reply {
            Reply::Reset {
                reason,
                resets,
                place,
                origin,
                cfsr,
                hfsr,
                address,
                file,
            } => Some(Self {
                reason,
                resets,
                place,
                origin,
                status: [cfsr, hfsr, address],
                file: file.to_owned(),
            }),
            _ => None,
        }
    }
}

/// What may be saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Kind {
    /// Parameters.
    Parameters = 1,
    /// The map of the encoder.
    EncoderMap = 2,
    /// The table of the screw.
    ScrewTable = 3,
}

/// What is saved of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stored {
    /// Version of its format.
    pub version: u16,
    /// Its length, bytes; 0: nothing is saved.
    pub length: u32,
    /// Its checksum.
    pub crc: u32,
}

impl Axis {
    /// The fault that is latched, with its context; `None` where there is none.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn fault_page(&mut self) -> Result<Option<FaultPage>, Error> {
        let page = self.query(&Request::FaultPage {}, FaultPage::of)?;
        Ok((page.fault_number != 0).then_some(page))
    }

    /// What its tick counted.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn tick_counters(&mut self) -> Result<TickCounters, Error> {
        self.query(&Request::Counters {}, TickCounters::of)
    }

    /// Why its firmware was last started anew without being asked to.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn last_reset(&mut self) -> Result<LastReset, Error> {
        self.query(&Request::LastReset {}, LastReset::of)
    }

    /// Saves the parameters in force, while the axis is off.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn save_parameters(&mut self) -> Result<(), Error> {
        self.order(&Request::SaveParameters {})
    }

    /// What is saved of a kind.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn stored(&mut self, kind: Kind) -> Result<Stored, Error> {
        let request = Request::Stored { kind: kind as u8 };
        self.query(&request, |reply| match *reply {
            Reply::Stored {
                version,
                length,
                crc,
                ..
            } => Some(Stored {
                version,
                length,
                crc,
            }),
            _ => None,
        })
    }

    /// The bytes of what is saved, as a backup keeps them.
    ///
    /// # Errors
    /// [`Error::Refused`] where nothing is saved; [`Error::Unexpected`] if it changes meanwhile.
    pub fn read_stored(&mut self, kind: Kind) -> Result<Vec<u8>, Error> {
        let before = self.stored(kind)?;
        let mut bytes = Vec::new();
        while bytes.len() < before.length.min(MOST) as usize {
            let offset = bytes.len() as u32;
            let request = Request::ReadStored {
                kind: kind as u8,
                offset,
            };
            let more = self.query(&request, |reply| match *reply {
                Reply::Bytes { offset: at, bytes } if at == offset && !bytes.is_empty() => {
                    Some(bytes.to_vec())
                }
                _ => None,
            })?;
            bytes.extend(more);
        }
        if bytes.len() == before.length as usize && self.stored(kind)? == before {
            Ok(bytes)
        } else {
            Err(Error::Unexpected {
                asked: "ReadStored".to_owned(),
            })
        }
    }

    /// Saves bytes that [`Self::read_stored`] gave, while the axis is off. They are in use after a restart.
    ///
    /// # Errors
    /// [`Error::Refused`] with what is wrong with them, or where the work memory is in use.
    pub fn write_stored(&mut self, kind: Kind, bytes: &[u8]) -> Result<(), Error> {
        for (number, chunk) in bytes.chunks(CHUNK).enumerate() {
            let offset = (number * CHUNK) as u32;
            self.order(&Request::WriteBytes {
                offset,
                bytes: chunk,
            })?;
        }
        self.order(&Request::SaveBytes {
            kind: kind as u8,
            length: bytes.len() as u32,
            crc: checksum(bytes),
        })
    }

    /// Erases what is saved of a kind, or all of it, while the axis is off. It is out of use after a restart.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn erase(&mut self, kind: Option<Kind>) -> Result<(), Error> {
        let kind = kind.map_or(0, |kind| kind as u8);
        self.order(&Request::Erase { kind })
    }

    /// Starts the firmware anew, while the axis is off, and connects again. What was not saved is lost, the origin too.
    ///
    /// # Errors
    /// [`Error::Refused`]; [`Error::Lost`] if it does not come back on this line.
    pub fn restart(&mut self) -> Result<(), Error> {
        self.order(&Request::Restart {})?;
        self.connection.forget_lease();
        let until = self
            .connection
            .now()
            .saturating_add(self.connection.options().timing.settle);
        // It answers before it goes.
        self.connection.wait(GONE)?;
        loop {
            match self.reconnect() {
                Err(Error::Lost { .. }) if self.connection.now() < until => {}
                done => return done,
            }
        }
    }

    /// Words of the work memory, from one on: as many as a reply holds.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn read_work(&mut self, offset: u32) -> Result<Vec<i32>, Error> {
        self.query(&Request::ReadWork { offset }, |reply| match *reply {
            Reply::Words { offset: at, bytes } if at == offset => {
                let (words, _) = bytes.as_chunks::<4>();
                Some(words.iter().map(|word| i32::from_le_bytes(*word)).collect())
            }
            _ => None,
        })
    }
}
