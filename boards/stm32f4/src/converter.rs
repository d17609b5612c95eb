//! The output converter on SPI 1, polled and bounded; `leadscrew_app::converter` has its words.

use embassy_stm32::pac;
use embassy_stm32::pac::spi::vals::{Br, Cpha, Cpol, Mstr};
use leadscrew::units::Command;
use leadscrew_app::converter::{Bus, PUT_OUT_ZERO, Trouble, Upkeep};

use crate::clocks::CORE_HZ;
use crate::{gpio, pins};

/// Turns of the wait for a byte: one takes 128 clocks of the core, and a turn some 10.
const PATIENCE: u32 = 100;
/// Waited after a reset, in parts of a second: ten times what the datasheet has for the reference.
const SETTLES: u32 = 1_000;

/// SPI 1, 10.5 MHz, data taken with the falling edge of its clock.
struct Spi;

impl Bus for Spi {
    fn exchange(&mut self, word: u32) -> Option<u32> {
        gpio::set(pins::CONVERTER_SYNC, false);
        let [_, bytes @ ..] = word.to_be_bytes();
        let mut back = Some(0);
        for byte in bytes {
            back = back.and_then(|back| Some(back << 8 | u32::from(exchange_byte(byte)?)));
        }
        gpio::set(pins::CONVERTER_SYNC, true);
        back
    }

    fn hold_reset(&mut self, is_held: bool) {
        gpio::set(pins::CONVERTER_RESET, !is_held);
    }
}

fn exchange_byte(byte: u8) -> Option<u8> {
    let spi = pac::SPI1;
    spi.dr().write(|w| w.set_dr(byte.into()));
    for _ in 0..PATIENCE {
        if spi.sr().read().rxne() {
            return Some(spi.dr().read().dr() as u8);
        }
    }
    None
}

/// What puts the command out.
pub struct Output(Upkeep);

impl Output {
    /// Sets the converter up at 0 V. What is wrong with it is told; it is tried again in the ticks.
    pub fn start() -> (Self, Option<Trouble>) {
        let spi = pac::SPI1;
        spi.cr1().write(|w| {
            w.set_mstr(Mstr::MASTER);
            w.set_br(Br::DIV8);
            w.set_cpol(Cpol::IDLE_LOW);
            w.set_cpha(Cpha::SECOND_EDGE);
            w.set_ssm(true);
            w.set_ssi(true);
            w.set_spe(true);
        });
        let settle = || cortex_m::asm::delay(CORE_HZ / SETTLES);
        let upkeep = Upkeep::start(&mut Spi, true, settle);
        let trouble = upkeep.trouble();
        (Self(upkeep), trouble)
    }

    /// Takes the rate of the ticks to come, a second.
    pub fn pace(&mut self, tick_hz: f64) {
        self.0.pace(tick_hz);
    }

    /// Puts a command out, and gives what the converter says of it. `is_off`: drive off and brake closed.
    #[inline]
    pub fn put(&mut self, command: Command, is_off: bool) -> Command {
        let is_alert = !gpio::is_high(pins::CONVERTER_ALERT);
        self.0.put(&mut Spi, command, is_off, is_alert).readback
    }
}

/// Zero, and then the reset of the converter, which clamps its output to ground: also if it did not hear.
pub fn release() {
    // A word that was under way ends here.
    gpio::set(pins::CONVERTER_SYNC, true);
    let _ = Spi.exchange(PUT_OUT_ZERO);
    gpio::set(pins::CONVERTER_RESET, false);
}
