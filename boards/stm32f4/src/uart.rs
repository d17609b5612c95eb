//! The UARTs, driven by interrupts: bytes go through queues, and thread mode waits for nothing.
//!
//! ```text
//! wire ─► interrupt ─► queue ─► Line::read   (thread mode)
//! wire ◄─ interrupt ◄─ queue ◄─ Line::send   (thread mode; asks for the interrupt)
//! ```

use core::sync::atomic::{AtomicU32, Ordering};

use embassy_stm32::interrupt;
use embassy_stm32::pac;
use embassy_stm32::pac::usart::Usart;
use heapless::spsc::{Consumer, Producer, Queue};

use crate::clocks::APB2_HZ;
use crate::isr_cell::IsrCell;
use crate::pins::{self, Pin};
use crate::gpio;

/// Bytes that may have come and not been read, less one: 11 ms of a line of 921 600 bits a second.
const RECEIVED: usize = 1024;
/// Bytes that may wait to be sent, less one: 22 ms of such a line.
const TO_SEND: usize = 2048;

/// A UART with the interrupt's ends of its queues.
pub struct Uart {
    registers: Usart,
    /// Switches the driver of a half-duplex line on.
    sends: Option<Pin>,
    received: IsrCell<Producer<'static, u8>>,
    to_send: IsrCell<Consumer<'static, u8>>,
    lost: AtomicU32,
}

/// The link.
pub static LINK: Uart = Uart::new(pac::USART1, None);
/// Modbus, half duplex.
pub static MODBUS: Uart = Uart::new(pac::USART6, Some(pins::MODBUS_SENDS));

/// The queues of a UART.
pub struct Queues {
    received: Queue<u8, RECEIVED>,
    to_send: Queue<u8, TO_SEND>,
}

impl Default for Queues {
    fn default() -> Self {
        Self::new()
    }
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
    const fn new(registers: Usart, sends: Option<Pin>) -> Self {
        Self {
            registers,
            sends,
            received: IsrCell::empty(),
            to_send: IsrCell::empty(),
            lost: AtomicU32::new(0),
        }
    }

    /// Starts the UART at `baud` bits a second, 8 bits, no parity. Its interrupt has to be masked.
    ///
    /// # Panics
    /// With the interrupt unmasked.
    pub fn open(&'static self, baud: u32, queues: &'static mut Queues) -> Line {
        let (came, received) = queues.received.split();
        let (to_send, going) = queues.to_send.split();
        assert!(
            self.received.put(came) && self.to_send.put(going),
            "interrupts are masked"
        );
        let registers = self.registers;
        // In sixteenths of a bit, as the register has it.
        let divider = (APB2_HZ + baud / 2) / baud.max(1);
        registers.brr().write(|w| w.0 = divider);
        registers.cr1().write(|w| {
            w.set_ue(true);
            w.set_te(true);
            w.set_re(true);
            w.set_rxneie(true);
        });
        Line {
            uart: self,
            received,
            to_send,
        }
    }

    /// A byte has come, there is room for one, or the last one is out.
    fn on_interrupt(&self) {
        let registers = self.registers;
        let status = registers.sr().read();
        if status.rxne() || status.ore() {
            // Reading both registers clears both flags.
            let byte = registers.dr().read().dr() as u8;
            let is_kept = status.rxne()
                && self
                    .received
                    .with(|queue| queue.enqueue(byte).is_ok())
                    .unwrap_or(false);
            let lost = u32::from(!is_kept) + u32::from(status.ore());
            // Only this interrupt writes.
            let before = self.lost.load(Ordering::Relaxed);
            self.lost
                .store(before.wrapping_add(lost), Ordering::Relaxed);
        }
        if status.txe() && registers.cr1().read().txeie() {
            self.send_next();
        }
        if status.tc() && registers.cr1().read().tcie() {
            self.end_sending();
        }
    }

    fn send_next(&self) {
        let registers = self.registers;
        match self.to_send.with(|queue| queue.dequeue()).flatten() {
            Some(byte) => {
                self.drive(true);
                registers.dr().write(|w| w.set_dr(byte.into()));
            }
            None => registers.cr1().modify(|w| {
                w.set_txeie(false);
                w.set_tcie(self.sends.is_some());
            }),
        }
    }

    /// The last bit is out; more may have been asked for meanwhile.
    fn end_sending(&self) {
        self.registers.cr1().modify(|w| w.set_tcie(false));
        if !self.registers.cr1().read().txeie() {
            self.drive(false);
        }
    }

    fn drive(&self, sends: bool) {
        if let Some(pin) = self.sends {
            gpio::set(pin, sends);
        }
    }

    /// Asks for the interrupt; the only write to the register that is not the interrupt's own.
    fn ask_to_send(&self) {
        critical_section::with(|_| self.registers.cr1().modify(|w| w.set_txeie(true)));
    }
}

impl Line {
    /// Moves what has come to the front of `place`; the number of bytes.
    pub fn read(&mut self, place: &mut [u8]) -> usize {
        let came = core::iter::from_fn(|| self.received.dequeue());
        let mut count = 0;
        for (byte, came) in place.iter_mut().zip(came) {
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
        self.uart.ask_to_send();
        true
    }

    /// Whether all has left the UART.
    pub fn is_sent(&self) -> bool {
        self.to_send.is_empty() && self.uart.registers.sr().read().tc()
    }

    /// Bytes that came and were lost; wraps.
    pub fn lost(&self) -> u32 {
        self.uart.lost.load(Ordering::Relaxed)
    }
}

#[interrupt]
fn USART1() {
    LINK.on_interrupt();
}

#[interrupt]
fn USART6() {
    MODBUS.on_interrupt();
}
