//! A line to the host that keeps step with it: virtual time stands still while the host has its turn.
//!
//! At a barrier the guest writes what it has to say to one FIFO and reads what it is told from another. QEMU is inside
//! the semihosting call meanwhile and executes nothing, so the run depends on the bytes alone, and the same bytes give
//! the same run.
//!
//! ```text
//! guest to host   tick u32, length u16, bytes      DIR/to-host
//! host to guest   ticks u16, length u16, bytes     DIR/to-guest
//! ```
//!
//! Numbers are little-endian. `tick` is the number of ticks that have run; `ticks` is how many are to run up to the next
//! barrier, and 0 ends the program. The first barrier is before the first tick.

use core::ffi::CStr;
use core::fmt::Write as _;

use heapless::{String, Vec};
use semihosting::fs::{File, OpenOptions};
use semihosting::io::{Read, Write};
use static_cell::ConstStaticCell;

/// Bytes that a barrier takes to the host at most.
const OUTBOX: usize = 32 * 1024;
/// Bytes that a barrier brings at most.
const INBOX: usize = 8 * 1024;
const LONGEST_PATH: usize = 256;

static BOXES: ConstStaticCell<Boxes> = ConstStaticCell::new(Boxes {
    outbox: Vec::new(),
    inbox: Vec::new(),
});

struct Boxes {
    /// Header and bytes.
    outbox: Vec<u8, OUTBOX>,
    inbox: Vec<u8, INBOX>,
}

/// The guest's end of the line.
pub struct Lockstep {
    to_host: File,
    to_guest: File,
    boxes: &'static mut Boxes,
    /// Bytes of the inbox that have been read.
    read: usize,
    /// The tick of the next barrier.
    due: u32,
}

/// Why the line is of no use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum LockstepError {
    /// The folder's path is too long: use a shorter one.
    PathTooLong,
    /// One of the FIFOs cannot be opened: the host makes them before it starts QEMU.
    NoFifo,
    /// The host has closed its end.
    HostGone,
    /// The host sent more bytes than a barrier brings.
    TooLong {
        /// How many.
        found: usize,
        /// How many there may be.
        most: usize,
    },
}

/// What the host wants next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Go on.
    Run,
    /// End the program.
    End,
}

const HEADER_OUT: usize = 6;
const HEADER_IN: usize = 4;

impl Lockstep {
    /// The line of the FIFOs in `folder`; the first barrier is due at once.
    ///
    /// # Errors
    /// The FIFOs cannot be opened.
    ///
    /// # Panics
    /// On the second call.
    pub fn open(folder: &str) -> Result<Self, LockstepError> {
        let mut write = OpenOptions::new();
        write.write(true).create(true).truncate(true);
        let mut read = OpenOptions::new();
        read.read(true);
        let boxes = BOXES.take();
        let _ = boxes.outbox.extend_from_slice(&[0; HEADER_OUT]);
        Ok(Self {
            // The order in which the host waits for them, where it waits.
            to_host: open(folder, "to-host", &write)?,
            to_guest: open(folder, "to-guest", &read)?,
            boxes,
            read: 0,
            due: 0,
        })
    }

    /// Whether a barrier is due after `tick` ticks.
    pub fn is_due(&self, tick: u32) -> bool {
        tick.wrapping_sub(self.due).cast_signed() >= 0
    }

    /// The barrier: the host's turn. What it sent is there to read afterwards; what was not read before is lost.
    ///
    /// # Errors
    /// The host is gone, or does not keep to the protocol.
    pub fn exchange(&mut self, tick: u32) -> Result<Turn, LockstepError> {
        let Boxes { outbox, inbox } = &mut *self.boxes;
        // OUTBOX is below 2¹⁶.
        let len = (outbox.len() - HEADER_OUT) as u16;
        outbox[..4].copy_from_slice(&tick.to_le_bytes());
        outbox[4..HEADER_OUT].copy_from_slice(&len.to_le_bytes());
        self.to_host
            .write_all(outbox)
            .map_err(|_| LockstepError::HostGone)?;
        outbox.truncate(HEADER_OUT);

        let mut header = [0; HEADER_IN];
        self.to_guest
            .read_exact(&mut header)
            .map_err(|_| LockstepError::HostGone)?;
        let [ticks_low, ticks_high, len_low, len_high] = header;
        let ticks = u16::from_le_bytes([ticks_low, ticks_high]);
        let found = usize::from(u16::from_le_bytes([len_low, len_high]));
        if inbox.resize(found, 0).is_err() {
            return Err(LockstepError::TooLong { found, most: INBOX });
        }
        self.to_guest
            .read_exact(inbox)
            .map_err(|_| LockstepError::HostGone)?;
        self.read = 0;
        self.due = tick.wrapping_add(u32::from(ticks));
        Ok(if ticks == 0 { Turn::End } else { Turn::Run })
    }

    /// Moves what has come to the front of `place`; the number of bytes.
    pub fn read(&mut self, place: &mut [u8]) -> usize {
        let waiting = &self.boxes.inbox[self.read..];
        let count = waiting.len().min(place.len());
        place[..count].copy_from_slice(&waiting[..count]);
        self.read += count;
        count
    }

    /// Whether all that was to be sent has gone at a barrier.
    pub fn is_sent(&self) -> bool {
        self.boxes.outbox.len() == HEADER_OUT
    }

    /// Sends all of `bytes` at the next barrier if there is room for them, else nothing.
    pub fn send(&mut self, bytes: &[u8]) -> bool {
        self.boxes.outbox.extend_from_slice(bytes).is_ok()
    }
}

fn open(folder: &str, name: &str, options: &OpenOptions) -> Result<File, LockstepError> {
    let mut path = String::<LONGEST_PATH>::new();
    write!(path, "{folder}/{name}\0").map_err(|_| LockstepError::PathTooLong)?;
    let path =
        CStr::from_bytes_with_nul(path.as_bytes()).map_err(|_| LockstepError::PathTooLong)?;
    options.open(path).map_err(|_| LockstepError::NoFifo)
}
