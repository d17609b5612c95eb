//! The UARTs, driven by interrupts: bytes go through queues, and thread mode waits for nothing.
//! [`board_common::line`] has the queues.

use board_common::line::{self, Ends, Wire};
use embassy_stm32::interrupt;
use embassy_stm32::pac;
use embassy_stm32::pac::usart::Usart;

use crate::clocks::APB2_HZ;
use crate::gpio;
use crate::pins::{self, Pin};

/// Bytes that may have come and not been read, less one: 11 ms of a line of 921 600 bits a second.
const RECEIVED: usize = 1024;
/// Bytes that may wait to be sent, less one: 22 ms of such a line.
const TO_SEND: usize = 2048;

/// A UART with the interrupt's ends of its queues.
pub struct Uart {
    registers: Usart,
    /// Switches the driver of a half-duplex line on.
    sends: Option<Pin>,
    ends: Ends,
}

/// The link.
pub static LINK: Uart = Uart::new(pac::USART1, None);
/// Modbus, half duplex.
pub static MODBUS: Uart = Uart::new(pac::USART6, Some(pins::MODBUS_SENDS));

/// The queues of a UART.
pub type Queues = line::Queues<RECEIVED, TO_SEND>;
/// Thread mode's end of a UART.
pub type Line = line::Line<Uart>;

impl Uart {
    const fn new(registers: Usart, sends: Option<Pin>) -> Self {
        Self {
            registers,
            sends,
            ends: Ends::new(),
        }
    }

    /// Starts the UART at `baud` bits a second, 8 bits, no parity. Its interrupt has to be masked.
    ///
    /// # Panics
    /// With the interrupt unmasked.
    pub fn open(&'static self, baud: u32, queues: &'static mut Queues) -> Line {
        let line = Line::open(self, queues);
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
        line
    }

    /// A byte has come, there is room for one, or the last one is out.
    fn on_interrupt(&self) {
        let registers = self.registers;
        let status = registers.sr().read();
        if status.rxne() || status.ore() {
            // Reading both registers clears both flags.
            let byte = registers.dr().read().dr() as u8;
            if status.rxne() {
                self.ends.came(byte);
            }
            if status.ore() {
                self.ends.note_lost();
            }
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
        match self.ends.next() {
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
}

impl Wire for Uart {
    /// The only write to the register that is not the interrupt's own.
    fn ask_to_send(&self) {
        critical_section::with(|_| self.registers.cr1().modify(|w| w.set_txeie(true)));
    }

    fn is_idle(&self) -> bool {
        self.registers.sr().read().tc()
    }

    fn ends(&self) -> &Ends {
        &self.ends
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
