//! Finds frames in whatever comes over a line.
//!
//! On a wire a frame ends with silence. That time is lost in buffers, bridges and emulators, which hand over whole frames
//! at once, two together, or one in pieces. So a frame whose length its function tells and whose CRC is right is taken at
//! once; what turns out to be none is left behind byte by byte; and silence ends whatever is left. Frames of other units,
//! requests and replies, are passed over as a whole, so that what they carry is not taken for a frame.

use crc::{CRC_16_MODBUS, Crc};
use rmodbus::consts::ModbusFunction;
use rmodbus::{ErrorKind, ModbusProto, guess_request_frame_len, guess_response_frame_len};

use super::Config;

/// Longest frame, bytes.
pub const MAX_FRAME: usize = 256;
/// Shortest frame: unit, function, CRC.
const MIN_FRAME: usize = 4;

// By a table of 512 bytes, as a static: hostile bytes have it computed at every place of the buffer.
static CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_MODBUS);

/// Checksum of `bytes`; it follows them low byte first.
#[must_use]
pub fn checksum(bytes: &[u8]) -> u16 {
    CRC.checksum(bytes)
}

/// What has come and is not yet understood.
#[derive(Debug)]
pub struct Line {
    config: Config,
    bytes: [u8; MAX_FRAME],
    length: usize,
    /// When the last byte came, µs.
    last_us: u32,
    /// Bytes that belonged to no frame; wraps.
    dropped: u32,
}

/// What the bytes at a place are.
enum Verdict {
    /// A frame to this unit of that length.
    Take(usize),
    /// A frame of another unit.
    Pass(usize),
    /// No frame begins here.
    Drop,
    /// It may become one.
    Wait,
}

impl Line {
    /// A line that is silent.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            bytes: [0; MAX_FRAME],
            length: 0,
            last_us: 0,
            dropped: 0,
        }
    }

    /// Takes bytes that came by `now_us`; shows `take` each frame to this unit, and how many bytes were dropped so far.
    pub fn receive(&mut self, bytes: &[u8], now_us: u32, mut take: impl FnMut(&[u8], u32)) {
        if bytes.is_empty() {
            return;
        }
        if self.is_silent(now_us) {
            // Whoever sent it has given it up.
            self.drop_all();
        }
        self.last_us = now_us;
        let mut rest = bytes;
        while !rest.is_empty() {
            let room = MAX_FRAME - self.length;
            let (now, later) = rest.split_at(room.min(rest.len()));
            self.bytes[self.length..self.length + now.len()].copy_from_slice(now);
            self.length += now.len();
            rest = later;
            self.search(false, &mut take);
            if self.length == MAX_FRAME {
                self.dropped = self.dropped.wrapping_add(1);
                self.forget(1);
                self.search(false, &mut take);
            }
        }
    }

    /// Ends what has come if the line is silent since.
    pub fn poll(&mut self, now_us: u32, mut take: impl FnMut(&[u8], u32)) {
        if self.is_silent(now_us) {
            self.search(true, &mut take);
            self.drop_all();
        }
    }

    const fn is_silent(&self, now_us: u32) -> bool {
        self.length > 0 && now_us.wrapping_sub(self.last_us) >= self.config.silence_us()
    }

    fn drop_all(&mut self) {
        self.dropped = self.dropped.wrapping_add(self.length as u32);
        self.length = 0;
    }

    fn forget(&mut self, count: usize) {
        self.bytes.copy_within(count..self.length, 0);
        self.length -= count;
    }

    /// Goes through what has come as far as it is decided; `is_over`: no more comes.
    fn search(&mut self, is_over: bool, take: &mut impl FnMut(&[u8], u32)) {
        let mut start = 0;
        while start < self.length {
            let rest = &self.bytes[start..self.length];
            start += match examine(rest, self.config.unit(), is_over) {
                Verdict::Take(length) => {
                    take(&rest[..length], self.dropped);
                    length
                }
                Verdict::Pass(length) => length,
                Verdict::Drop => {
                    self.dropped = self.dropped.wrapping_add(1);
                    1
                }
                Verdict::Wait => break,
            };
        }
        self.forget(start);
    }
}

/// True if `bytes` end with their checksum.
fn is_checked(bytes: &[u8]) -> bool {
    bytes.split_last_chunk().is_some_and(|(content, check)| {
        bytes.len() >= MIN_FRAME && checksum(content) == u16::from_le_bytes(*check)
    })
}

fn examine(bytes: &[u8], unit: u8, is_over: bool) -> Verdict {
    let is_ours = bytes.first() == Some(&unit);
    let verdict = |length| {
        if is_ours {
            Verdict::Take(length)
        } else {
            Verdict::Pass(length)
        }
    };
    // Also of functions whose length is not known here.
    if is_over && is_checked(bytes) {
        return verdict(bytes.len());
    }
    let request = guess_request_frame_len(bytes, ModbusProto::Rtu);
    // To this unit come only requests.
    let reply = if is_ours {
        Err(ErrorKind::FrameBroken)
    } else {
        guess_response_frame_len(bytes, ModbusProto::Rtu)
    };
    let mut is_decided = is_over || is_known(bytes);
    for guess in [request, reply] {
        match guess.map(usize::from) {
            Ok(length) => match bytes.get(..length) {
                Some(frame) if is_checked(frame) => return verdict(length),
                Some(_) => {}
                None => is_decided &= is_over,
            },
            Err(ErrorKind::OOB) => is_decided &= is_over,
            Err(_) => {}
        }
    }
    if is_decided {
        Verdict::Drop
    } else {
        Verdict::Wait
    }
}

/// True if the function, or that of an exception, tells the length.
fn is_known(bytes: &[u8]) -> bool {
    let function = bytes.get(1).map(|function| function & 0x7f);
    function.is_some_and(|function| ModbusFunction::try_from(function).is_ok())
}
