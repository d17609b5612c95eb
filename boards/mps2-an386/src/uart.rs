//! The UARTs of the board, driven by interrupts: bytes go through queues, and thread mode waits for nothing.
//!
//! ```text
//! wire ─► RX interrupt ─► queue ─► Line::read   (thread mode)
//! wire ◄─ TX interrupt ◄─ queue ◄─ Line::send   (thread mode; pends the TX line)
//! ```
//!
//! The interrupts wake nobody: thread mode looks once a tick.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::NVIC;
use heapless::spsc::{Consumer, Producer, Queue};

use crate::CLOCK_HZ;
use crate::interrupts::{Interrupt, interrupt};
use crate::isr_cell::IsrCell;
use crate::registers::Registers;

/// Bytes that may have come and not been read, less one: 20 ms of a line of 1 Mbit/s.
const RECEIVED: usize = 2048;
/// Bytes that may wait to be sent, less one: 80 ms of a line of 1 Mbit/s.
const TO_SEND: usize = 8192;

/// A CMSDK UART: one byte each way, 8 bits, no parity.
struct Cmsdk(Registers);

impl Cmsdk {
    const DATA: usize = 0x00;
    const STATE: usize = 0x04;
    const CTRL: usize = 0x08;
    const INTERRUPT: usize = 0x0c;
    const DIVIDER: usize = 0x10;
    const TX: u32 = 0b01;
    const RX: u32 = 0b10;
    const RX_OVERRUN: u32 = 0b1000;
    const ENABLE_WITH_INTERRUPTS: u32 = 0b1111;
    /// The smallest that the UART takes.
    const LEAST_DIVIDER: u32 = 16;

    fn start(&self, baud: u32) {
        let divider = (CLOCK_HZ / baud.max(1)).max(Self::LEAST_DIVIDER);
        self.0.write(Self::CTRL, 0);
        self.0.write(Self::DIVIDER, divider);
        self.0.write(Self::CTRL, Self::ENABLE_WITH_INTERRUPTS);
    }

    fn has_room(&self) -> bool {
        self.0.read(Self::STATE) & Self::TX == 0
    }

    fn put(&self, byte: u8) {
        self.0.write(Self::DATA, u32::from(byte));
    }

    fn get(&self) -> u8 {
        self.0.read(Self::DATA).to_le_bytes()[0]
    }

    /// Whether a byte was lost because the one before had not been fetched; clears it.
    fn take_overrun(&self) -> bool {
        let is_overrun = self.0.read(Self::STATE) & Self::RX_OVERRUN != 0;
        if is_overrun {
            self.0.write(Self::STATE, Self::RX_OVERRUN);
        }
        is_overrun
    }

    fn acknowledge(&self, which: u32) {
        self.0.write(Self::INTERRUPT, which);
    }
}

/// A UART with the interrupts' ends of its queues.
pub struct Uart {
    registers: Cmsdk,
    transmit: Interrupt,
    receive: Interrupt,
    received: IsrCell<Producer<'static, u8>>,
    to_send: IsrCell<Consumer<'static, u8>>,
    lost: AtomicU32,
}

/// UART 0, lines `UART0RX` and `UART0TX`.
pub static UART0: Uart = Uart::new(0x4000_4000, Interrupt::UART0RX, Interrupt::UART0TX);
/// UART 1, lines `UART1RX` and `UART1TX`.
pub static UART1: Uart = Uart::new(0x4000_5000, Interrupt::UART1RX, Interrupt::UART1TX);

/// The queues of a UART.
#[derive(Default)]
pub struct Queues {
    received: Queue<u8, RECEIVED>,
    to_send: Queue<u8, TO_SEND>,
}

impl Queues {
    /// Empty ones.
    pub const fn new() -> Self {
        Self {
            received: Queue::new(),
            to_send: Queue::new(),
        }
    }
}

/// Thread mode's end of a UART.
pub struct Line {
    uart: &'static Uart,
    received: Consumer<'static, u8>,
    to_send: Producer<'static, u8>,
}

impl Uart {
    const fn new(address: usize, receive: Interrupt, transmit: Interrupt) -> Self {
        Self {
            registers: Cmsdk(Registers::new(address)),
            transmit,
            receive,
            received: IsrCell::empty(),
            to_send: IsrCell::empty(),
            lost: AtomicU32::new(0),
        }
    }

    /// Its interrupt lines, both to be unmasked.
    pub const fn lines(&self) -> [Interrupt; 2] {
        [self.receive, self.transmit]
    }

    /// Starts the UART at `baud`, or as near as its divider comes. Its interrupts have to be masked.
    pub fn open(&'static self, baud: u32, queues: &'static mut Queues) -> Line {
        let (came, received) = queues.received.split();
        let (to_send, going) = queues.to_send.split();
        assert!(
            self.received.put(came) && self.to_send.put(going),
            "interrupts are masked"
        );
        self.registers.start(baud);
        Line {
            uart: self,
            received,
            to_send,
        }
    }

    /// A byte has come.
    fn on_receive(&self) {
        // Before the byte is fetched: the next one flags anew.
        self.registers.acknowledge(Cmsdk::RX);
        let byte = self.registers.get();
        let is_kept = self
            .received
            .with(|queue| queue.enqueue(byte).is_ok())
            .unwrap_or(false);
        let lost = u32::from(!is_kept) + u32::from(self.registers.take_overrun());
        // Only this interrupt writes.
        let before = self.lost.load(Ordering::Relaxed);
        self.lost
            .store(before.wrapping_add(lost), Ordering::Relaxed);
    }

    /// The last byte is on its way, or thread mode has pended the line.
    fn on_transmit(&self) {
        self.registers.acknowledge(Cmsdk::TX);
        self.to_send.with(|queue| {
            while self.registers.has_room()
                && let Some(byte) = queue.dequeue()
            {
                self.registers.put(byte);
            }
        });
    }
}

impl Line {
    /// Moves what has come to the front of `place`; the number of bytes.
    pub fn read(&mut self, place: &mut [u8]) -> usize {
        let mut count = 0;
        for (byte, came) in place
            .iter_mut()
            .zip(core::iter::from_fn(|| self.received.dequeue()))
        {
            *byte = came;
            count += 1;
        }
        count
    }

    /// Sends all of `bytes` if there is room for them, else nothing.
    pub fn send(&mut self, bytes: &[u8]) -> bool {
        let room = self.to_send.capacity() - self.to_send.len();
        if bytes.len() > room {
            return false;
        }
        for byte in bytes {
            // There is room: this is the only producer.
            let _ = self.to_send.enqueue(*byte);
        }
        NVIC::pend(self.uart.transmit);
        true
    }

    /// Whether all has been handed to the UART.
    pub fn is_sent(&self) -> bool {
        self.to_send.is_empty()
    }

    /// Bytes that came and found no room; wraps.
    pub fn lost(&self) -> u32 {
        self.uart.lost.load(Ordering::Relaxed)
    }
}

#[interrupt]
fn UART0RX() {
    UART0.on_receive();
}

#[interrupt]
fn UART0TX() {
    UART0.on_transmit();
}

#[interrupt]
fn UART1RX() {
    UART1.on_receive();
}

#[interrupt]
fn UART1TX() {
    UART1.on_transmit();
}
