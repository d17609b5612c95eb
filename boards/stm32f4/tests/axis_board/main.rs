//! Tests on the board itself: `cargo test-f407`. `docs/board.md` has the wires and what is to be seen.
//!
//! ```text
//! PC6 (TIM3_CH1) ─► PA0, PA15     encoder A
//! PC9 (TIM3_CH4) ─► PA1, PB3      encoder B
//! ```
//!
//! Nothing else is connected but the converter, and no drive to it. Each test begins with a reset of the part.
#![no_std]
#![no_main]

// The firmware's own way from the flash to an axis.
#[path = "../../src/bin/firmware/boot.rs"]
mod boot;
mod capture;
#[path = "../../src/bin/firmware/factory.rs"]
mod factory;
mod generator;
#[allow(dead_code, reason = "only its types are needed by the boot")]
#[path = "../../src/bin/firmware/serve.rs"]
mod serve;
mod spacing;
mod spread;
mod stages;
mod timed_tick;

#[embedded_test::tests]
mod tests {
    use board_stm32f4::{clocks, gpio};

    use crate::{capture, stages};

    #[init]
    fn init() {
        clocks::start();
        gpio::configure();
    }

    #[test]
    fn ten_thousand_edges_a_second_are_captured_and_counted() {
        capture::uniform(8_400);
    }

    #[test]
    fn a_hundred_thousand_edges_a_second_are_captured_and_counted() {
        capture::uniform(840);
    }

    #[test]
    fn a_million_edges_a_second_are_captured_and_counted() {
        capture::uniform(84);
    }

    #[test]
    fn a_reversal_between_two_edges_is_counted() {
        capture::reversal(8_400);
    }

    #[test]
    fn a_fast_reversal_is_counted() {
        capture::reversal(840);
    }

    /// The program samples late and at odd moments; count and time are of the tick.
    #[test]
    fn the_hardware_samples_at_the_tick() {
        capture::late_readers();
    }

    #[test]
    fn the_converter_reads_back_what_it_was_told() {
        stages::converter();
    }

    /// At the rate of the stored configuration, 1 kHz from the factory.
    #[test]
    fn ticks_start_in_time_and_end_within_their_budget() {
        stages::ticks();
    }
}
