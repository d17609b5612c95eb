//! An encoder made of TIM3: its channels 1 and 4 toggle in turn, a fixed number of clocks apart, by hardware alone.
//!
//! TIM3 runs at the clock of TIM5, which stamps the edges. PC6 is an output of the board anyway (Modbus, whose driver is off), PC9 is free.

use embassy_stm32::pac;
use embassy_stm32::pac::gpio::vals::Moder;
use embassy_stm32::pac::timer::vals::{CcmrOutputCcs, Ocm};

/// Pins of A and B on port C.
const PINS: [usize; 2] = [6, 9];
/// Channels 1 and 4, as the registers count them.
const CHANNELS: [usize; 2] = [0, 3];
/// TIM3 on the pins.
const FUNCTION: u8 = 2;

/// The encoder, turning.
pub struct Generator {
    /// Clocks from edge to edge.
    spacing: u16,
}

impl Generator {
    /// Lets it turn forward, `spacing` clocks from edge to edge, 16 to 32 767.
    pub fn start(spacing: u16) -> Self {
        let timer = pac::TIM3;
        timer.cr1().write(|_| {});
        timer.smcr().write(|_| {});
        timer.psc().write_value(0);
        timer.arr().write(|w| w.set_arr(2 * spacing - 1));
        for channel in CHANNELS {
            let mode = timer.ccmr_output(channel / 2);
            mode.modify(|w| {
                w.set_ccs(channel % 2, CcmrOutputCcs::OUTPUT);
                w.set_ocpe(channel % 2, true);
                // The levels that it begins with say which way it turns.
                w.set_ocm(channel % 2, Ocm::FORCE_INACTIVE);
            });
            mode.modify(|w| w.set_ocm(channel % 2, Ocm::TOGGLE));
        }
        let generator = Self { spacing };
        generator.toggle_at([spacing / 2, spacing / 2 + spacing]);
        timer.egr().write(|w| w.set_ug(true));
        timer.ccer().write(|w| {
            for channel in CHANNELS {
                w.set_cce(channel, true);
            }
        });
        for pin in PINS {
            pac::GPIOC
                .afr(pin / 8)
                .modify(|w| w.set_afr(pin % 8, FUNCTION));
            pac::GPIOC
                .moder()
                .modify(|w| w.set_moder(pin, Moder::ALTERNATE));
        }
        timer.cr1().write(|w| {
            w.set_arpe(true);
            w.set_cen(true);
        });
        generator
    }

    /// Turns it round with the next period: B, which toggled last, toggles first. The distance stays the same.
    pub fn reverse(&mut self) {
        let (first, second) = (self.spacing / 2, self.spacing / 2 + self.spacing);
        // Both channels with one update.
        pac::TIM3.cr1().modify(|w| w.set_udis(true));
        self.toggle_at([second, first]);
        pac::TIM3.cr1().modify(|w| w.set_udis(false));
    }

    /// Clocks of the period at which A and B toggle.
    fn toggle_at(&self, places: [u16; 2]) {
        for (channel, place) in CHANNELS.into_iter().zip(places) {
            pac::TIM3.ccr(channel).write(|w| w.set_ccr(place));
        }
    }
}

impl Drop for Generator {
    /// It stands still, and its pins keep their levels.
    fn drop(&mut self) {
        pac::TIM3.cr1().modify(|w| w.set_cen(false));
    }
}
