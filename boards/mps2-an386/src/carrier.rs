//! What carries the link: a UART, or the line in lockstep.

use board_common::line::Bytes;
use heapless::String;

use crate::lockstep::{Lockstep, LockstepError, Turn};
use crate::uart::{self, Line, UART0};
use static_cell::ConstStaticCell;

/// Longest path of a folder or a file on the command line.
pub const LONGEST_PATH: usize = 240;

/// A path that a program was given.
pub type Path = String<LONGEST_PATH>;

/// What carries the link.
pub enum Carrier {
    /// UART 0.
    Uart(Line),
    /// In lockstep with the host.
    Lockstep(Lockstep),
}

impl Carrier {
    /// The line in lockstep where there is a folder with its FIFOs, else UART 0 at `baud`.
    ///
    /// # Errors
    /// The FIFOs cannot be opened.
    ///
    /// # Panics
    /// On the second call, or with the UART's interrupts unmasked.
    pub fn open(folder: Option<&str>, baud: u32) -> Result<Self, LockstepError> {
        static QUEUES: ConstStaticCell<uart::Queues> = ConstStaticCell::new(uart::Queues::new());
        match folder {
            Some(folder) => Lockstep::open(folder).map(Self::Lockstep),
            None => Ok(Self::Uart(UART0.open(baud, QUEUES.take()))),
        }
    }

    /// Gives the host its turn where it is due after `tick` ticks; a UART does not wait for anybody.
    ///
    /// # Errors
    /// The host is gone, or does not keep to the protocol.
    pub fn keep_step(&mut self, tick: u32) -> Result<Turn, LockstepError> {
        match self {
            Self::Lockstep(lockstep) if lockstep.is_due(tick) => lockstep.exchange(tick),
            _ => Ok(Turn::Run),
        }
    }
}

impl Bytes for Carrier {
    fn read(&mut self, place: &mut [u8]) -> usize {
        match self {
            Self::Uart(line) => line.read(place),
            Self::Lockstep(lockstep) => lockstep.read(place),
        }
    }

    fn send(&mut self, bytes: &[u8]) -> bool {
        match self {
            Self::Uart(line) => line.send(bytes),
            Self::Lockstep(lockstep) => lockstep.send(bytes),
        }
    }

    fn is_sent(&self) -> bool {
        match self {
            Self::Uart(line) => line.is_sent(),
            Self::Lockstep(lockstep) => lockstep.is_sent(),
        }
    }
}
