//! SPI1 as a master, polled: bytes of eight bits at its rate. RM0090, chapter 28.

use super::pins::SharedSurroundings;
use super::registers::{Model, NEVER};
use crate::emulator::lock;

const RECEIVED: u32 = 1 << 0;
const EMPTY: u32 = 1 << 1;
const OVERRUN: u32 = 1 << 6;
const BUSY: u32 = 1 << 7;
const ENABLED: u32 = 1 << 6;
const MASTER: u32 = 1 << 2;

/// The registers.
pub struct Spi {
    around: SharedSurroundings,
    control: [u32; 2],
    received: Option<u8>,
    overrun: bool,
    waiting: Option<u8>,
    /// The byte that is shifted, and when its last bit is.
    shifting: Option<(u8, u64)>,
}

impl std::fmt::Debug for Spi {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Spi").finish_non_exhaustive()
    }
}

impl Spi {
    pub const fn new(around: SharedSurroundings) -> Self {
        Self {
            around,
            control: [0; 2],
            received: None,
            overrun: false,
            waiting: None,
            shifting: None,
        }
    }

    fn start(&mut self, now: u64) {
        if self.shifting.is_none()
            && self.control[0] & (ENABLED | MASTER) == ENABLED | MASTER
            && let Some(byte) = self.waiting.take()
        {
            let clocks_per_bit = 2 << (self.control[0] >> 3 & 7);
            self.shifting = Some((byte, now + 8 * clocks_per_bit));
        }
    }
}

impl Model for Spi {
    fn read(&mut self, offset: u64, _now: u64, looks_only: bool) -> u32 {
        match offset {
            0x00 | 0x04 => self.control[offset as usize / 4],
            0x08 => {
                let flag = |is_set, flag| if is_set { flag } else { 0 };
                flag(self.received.is_some(), RECEIVED)
                    | flag(self.waiting.is_none(), EMPTY)
                    | flag(self.overrun, OVERRUN)
                    | flag(self.shifting.is_some(), BUSY)
            }
            0x0c if looks_only => self.received.unwrap_or_default().into(),
            0x0c => {
                self.overrun = false;
                self.received.take().unwrap_or_default().into()
            }
            0x10 => 7,
            _ => 0,
        }
    }

    fn write(&mut self, offset: u64, value: u32, now: u64) {
        match offset {
            0x00 | 0x04 => self.control[offset as usize / 4] = value,
            0x0c => self.waiting = Some(value as u8),
            _ => {}
        }
        self.start(now);
    }

    fn advance(&mut self, now: u64) {
        while let Some((byte, until)) = self.shifting
            && until <= now
        {
            let back = lock(&self.around).transfer(until, byte);
            self.overrun |= self.received.is_some();
            if !self.overrun {
                self.received = Some(back);
            }
            self.shifting = None;
            self.start(until);
        }
    }

    fn next_event(&self) -> u64 {
        self.shifting.map_or(NEVER, |(_, until)| until)
    }

    fn lines(&self) -> [bool; 2] {
        [false; 2]
    }

    fn reset(&mut self, _now: u64) {
        *self = Self::new(self.around.clone());
    }
}
