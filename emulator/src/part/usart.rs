//! A USART with its baud rate: every byte takes its ten bits, an idle line is told. RM0090, chapter 30.

use std::collections::VecDeque;

use super::registers::{Model, NEVER};

const OVERRUN: u32 = 1 << 3;
const IDLE: u32 = 1 << 4;
const RECEIVED: u32 = 1 << 5;
const COMPLETE: u32 = 1 << 6;
const EMPTY: u32 = 1 << 7;

/// Bits of the first control register: the interrupts stand where their flags do.
const RECEIVER: u32 = 1 << 2;
const TRANSMITTER: u32 = 1 << 3;
const ENABLED: u32 = 1 << 13;
/// Bits of a byte on the line.
const BITS: u64 = 10;

/// The registers, and what is on the line.
#[derive(Debug)]
pub struct Usart {
    status: u32,
    data: u8,
    baud: u32,
    control: [u32; 3],
    guard: u32,
    /// Status was read: reading the data now clears the flags.
    was_read: bool,
    waiting: Option<u8>,
    /// The byte that goes out, and when its last bit is out.
    going: Option<(u8, u64)>,
    sent: Vec<u8>,
    to_come: VecDeque<u8>,
    /// When the next byte is in, or the line is idle.
    coming_at: u64,
}

impl Default for Usart {
    fn default() -> Self {
        Self {
            status: EMPTY | COMPLETE,
            data: 0,
            baud: 0,
            control: [0; 3],
            guard: 0,
            was_read: false,
            waiting: None,
            going: None,
            sent: Vec::new(),
            to_come: VecDeque::new(),
            coming_at: NEVER,
        }
    }
}

impl Usart {
    /// Clocks of a byte.
    fn byte_time(&self) -> u64 {
        BITS * u64::from(self.baud.max(1))
    }

    fn is_on(&self, half: u32) -> bool {
        self.control[0] & (ENABLED | half) == ENABLED | half
    }

    /// Bytes for the part, which come one after the other from now on.
    pub fn bring(&mut self, bytes: &[u8], now: u64) {
        let was_quiet = self.to_come.is_empty();
        self.to_come.extend(bytes);
        if was_quiet && !bytes.is_empty() {
            self.coming_at = now + self.byte_time();
        }
    }

    /// What the part has sent since this was asked last.
    pub fn take(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.sent)
    }

    fn start_sending(&mut self, now: u64) {
        if self.going.is_none()
            && let Some(byte) = self.waiting.take()
        {
            self.going = Some((byte, now + self.byte_time()));
            self.status |= EMPTY;
        }
    }

    fn end_sending(&mut self, now: u64) {
        while let Some((byte, until)) = self.going
            && until <= now
        {
            self.sent.push(byte);
            self.going = None;
            self.start_sending(until);
            if self.going.is_none() {
                self.status |= COMPLETE;
            }
        }
    }

    fn receive(&mut self, now: u64) {
        while self.coming_at <= now {
            match self.to_come.pop_front() {
                None => {
                    self.status |= IDLE;
                    self.coming_at = NEVER;
                }
                Some(byte) => {
                    self.take_in(byte);
                    self.coming_at += self.byte_time();
                }
            }
        }
    }

    fn take_in(&mut self, byte: u8) {
        if !self.is_on(RECEIVER) {
            return;
        }
        if self.status & RECEIVED != 0 {
            self.status |= OVERRUN;
        } else {
            self.data = byte;
            self.status |= RECEIVED;
        }
    }
}

impl Model for Usart {
    fn read(&mut self, offset: u64, _now: u64, looks_only: bool) -> u32 {
        match offset {
            0x00 => {
                self.was_read |= !looks_only;
                self.status
            }
            0x04 => {
                if !looks_only {
                    self.status &= !RECEIVED;
                    if self.was_read {
                        self.status &= !(OVERRUN | IDLE);
                    }
                    self.was_read = false;
                }
                self.data.into()
            }
            0x08 => self.baud,
            0x0c | 0x10 | 0x14 => self.control[(offset as usize - 0x0c) / 4],
            0x18 => self.guard,
            _ => 0,
        }
    }

    fn write(&mut self, offset: u64, value: u32, now: u64) {
        match offset {
            0x00 => self.status &= value | !(RECEIVED | COMPLETE),
            0x04 if self.is_on(TRANSMITTER) => {
                self.waiting = Some(value as u8);
                self.status &= !(EMPTY | COMPLETE);
                self.start_sending(now);
            }
            0x08 => self.baud = value & 0xffff,
            0x0c | 0x10 | 0x14 => self.control[(offset as usize - 0x0c) / 4] = value,
            0x18 => self.guard = value,
            _ => {}
        }
    }

    fn advance(&mut self, now: u64) {
        self.end_sending(now);
        self.receive(now);
    }

    fn next_event(&self) -> u64 {
        let sending = self.going.map_or(NEVER, |(_, until)| until);
        sending.min(self.coming_at)
    }

    fn lines(&self) -> [bool; 2] {
        let enabled = self.control[0];
        let mut flags = self.status & (IDLE | RECEIVED | COMPLETE | EMPTY);
        if self.status & OVERRUN != 0 {
            flags |= RECEIVED;
        }
        [enabled & ENABLED != 0 && flags & enabled != 0, false]
    }

    /// What is on the line stays: it is not the part's.
    fn reset(&mut self, _now: u64) {
        let sent = std::mem::take(&mut self.sent);
        let to_come = std::mem::take(&mut self.to_come);
        *self = Self {
            sent,
            to_come,
            coming_at: self.coming_at,
            ..Self::default()
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BAUD: u32 = 91;

    fn open() -> Usart {
        let mut usart = Usart::default();
        usart.write(0x08, BAUD, 0);
        usart.write(0x0c, ENABLED | RECEIVER | TRANSMITTER | RECEIVED | IDLE, 0);
        usart
    }

    #[test]
    fn a_byte_takes_ten_bits_and_the_line_is_idle_another_ten_later() {
        let mut usart = open();
        usart.bring(&[7, 8], 100);
        usart.advance(100 + 909);
        assert_eq!(usart.lines(), [false; 2]);
        usart.advance(100 + 910);
        assert_eq!(usart.lines(), [true, false]);
        assert_eq!(usart.read(0x00, 0, false) & RECEIVED, RECEIVED);
        assert_eq!(usart.read(0x04, 0, false), 7);
        usart.advance(100 + 2 * 910);
        assert_eq!(usart.read(0x04, 0, false), 8);
        assert_eq!(usart.lines(), [false; 2]);
        usart.advance(100 + 3 * 910);
        assert_eq!(usart.read(0x00, 0, false) & IDLE, IDLE);
    }

    #[test]
    fn a_byte_that_is_not_fetched_in_time_costs_the_next_one() {
        let mut usart = open();
        usart.bring(&[7, 8], 0);
        usart.advance(910);
        usart.advance(1820);
        let status = usart.read(0x00, 0, false);
        assert_eq!(status & (OVERRUN | RECEIVED), OVERRUN | RECEIVED);
        assert_eq!(usart.read(0x04, 0, false), 7);
        assert_eq!(usart.read(0x00, 0, true) & (OVERRUN | RECEIVED), 0);
    }

    #[test]
    fn two_bytes_are_buffered_and_the_line_tells_when_all_is_out() {
        let mut usart = open();
        usart.write(0x04, 1, 0);
        assert_eq!(usart.read(0x00, 0, true) & (EMPTY | COMPLETE), EMPTY);
        usart.write(0x04, 2, 0);
        assert_eq!(usart.read(0x00, 0, true) & (EMPTY | COMPLETE), 0);
        usart.advance(910);
        assert_eq!(usart.read(0x00, 0, true) & (EMPTY | COMPLETE), EMPTY);
        assert_eq!(usart.take(), [1]);
        usart.advance(1820);
        assert_eq!(
            usart.read(0x00, 0, true) & (EMPTY | COMPLETE),
            EMPTY | COMPLETE
        );
        assert_eq!(usart.take(), [2]);
    }
}
