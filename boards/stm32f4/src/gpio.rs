//! Pins as the table has them.

use embassy_stm32::pac;
use embassy_stm32::pac::gpio::Gpio;
use embassy_stm32::pac::gpio::vals::{Idr, Moder, Odr, Ospeedr, Ot, Pupdr};

use crate::pins::{self, Mode, Pin, Pull};

const fn port(pin: Pin) -> Gpio {
    match pin.port {
        b'A' => pac::GPIOA,
        b'B' => pac::GPIOB,
        _ => pac::GPIOC,
    }
}

/// Sets all pins up, in the order of the table; the clocks of the ports are on.
pub fn configure() {
    for pin in pins::ALL {
        configure_one(pin);
    }
}

fn configure_one(pin: Pin) {
    let (gpio, number) = (port(pin), usize::from(pin.number));
    let pull = match pin.pull {
        Pull::None => Pupdr::FLOATING,
        Pull::Up => Pupdr::PULL_UP,
        Pull::Down => Pupdr::PULL_DOWN,
    };
    gpio.pupdr().modify(|w| w.set_pupdr(number, pull));
    gpio.otyper().modify(|w| w.set_ot(number, Ot::PUSH_PULL));
    let mode = match pin.mode {
        Mode::Alternate(function, _) => {
            gpio.afr(number / 8)
                .modify(|w| w.set_afr(number % 8, function));
            gpio.ospeedr()
                .modify(|w| w.set_ospeedr(number, Ospeedr::MEDIUM_SPEED));
            Moder::ALTERNATE
        }
        Mode::Input => Moder::INPUT,
        Mode::Output(level) => {
            // Before it drives.
            set(pin, level);
            Moder::OUTPUT
        }
        Mode::Analog => Moder::ANALOG,
    };
    gpio.moder().modify(|w| w.set_moder(number, mode));
}

/// Level of a pin.
#[inline(always)]
pub fn is_high(pin: Pin) -> bool {
    port(pin).idr().read().idr(usize::from(pin.number)) == Idr::HIGH
}

/// Whether an output is driven high.
pub fn is_driven(pin: Pin) -> bool {
    port(pin).odr().read().odr(usize::from(pin.number)) == Odr::HIGH
}

/// Sets an output.
#[inline(always)]
pub fn set(pin: Pin, level: bool) {
    let number = usize::from(pin.number);
    port(pin).bsrr().write(|w| {
        if level {
            w.set_bs(number, true);
        } else {
            w.set_br(number, true);
        }
    });
}
