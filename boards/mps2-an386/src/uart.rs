//! The UARTs of the board, driven by interrupts: bytes go through queues, and thread mode waits for nothing.
//! [`board_common::line`] has the queues.
//!
//! The interrupts wake nobody: thread mode looks once a tick.

use board_common::line::{self, Ends, Wire};
use cortex_m::peripheral::NVIC;

use crate::CLOCK_HZ;
use crate::interrupts::{Interrupt, interrupt};
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
    ends: Ends,
}

/// UART 0, lines `UART0RX` and `UART0TX`.
pub static UART0: Uart = Uart::new(0x4000_4000, Interrupt::UART0RX, Interrupt::UART0TX);
/// UART 1, lines `UART1RX` and `UART1TX`.
pub static UART1: Uart = Uart::new(0x4000_5000, Interrupt::UART1RX, Interrupt::UART1TX);

/// The queues of a UART.
pub type Queues = line::Queues<RECEIVED, TO_SEND>;
/// Thread mode's end of a UART.
pub type Line = line::Line<Uart>;

impl Uart {
    const fn new(address: usize, receive: Interrupt, transmit: Interrupt) -> Self {
        Self {
            registers: Cmsdk(Registers::new(address)),
            transmit,
            receive,
            ends: Ends::new(),
        }
    }

    /// Its interrupt lines, both to be unmasked.
    pub const fn lines(&self) -> [Interrupt; 2] {
        [self.receive, self.transmit]
    }

    /// Starts the UART at `baud`, or as near as its divider comes. Its interrupts have to be masked.
    pub fn open(&'static self, baud: u32, queues: &'static mut Queues) -> Line {
        let line = Line::open(self, queues);
        self.registers.start(baud);
        line
    }

    /// A byte has come.
    fn on_receive(&self) {
        // Before the byte is fetched: the next one flags anew.
        self.registers.acknowledge(Cmsdk::RX);
        self.ends.came(self.registers.get());
        if self.registers.take_overrun() {
            self.ends.note_lost();
        }
    }

    /// The last byte is on its way, or thread mode has pended the line.
    fn on_transmit(&self) {
        self.registers.acknowledge(Cmsdk::TX);
        while self.registers.has_room()
            && let Some(byte) = self.ends.next()
        {
            self.registers.put(byte);
        }
    }
}

impl Wire for Uart {
    fn ask_to_send(&self) {
        NVIC::pend(self.transmit);
    }

    /// What it was handed goes out by itself.
    fn is_idle(&self) -> bool {
        true
    }

    fn ends(&self) -> &Ends {
        &self.ends
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
