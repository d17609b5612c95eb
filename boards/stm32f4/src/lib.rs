//! The axis board: an STM32F405 or F407 with its encoder, converter and lines. `docs/board.md` has the wiring.
//!
//! ```text
//! clocks, pins, gpio                     what the board is
//! encoder, ring, latches, references ─► machine ─► tick ─► converter, lines
//! uart, flash, memory                    what the link works with, in thread mode
//! priorities, watchdog, stack            what keeps it safe
//! safe_state, reset_record               and what is known of it afterwards
//! ```
//!
//! The peripherals work together by hardware triggers, so they are set up by their registers; the HAL gives clocks, time and the
//! vector table. All `unsafe` of the firmware is in this crate, each with its reason.
#![no_std]

pub mod clocks;
pub mod converter;
pub mod encoder;
pub mod flash;
pub mod gpio;
pub mod latches;
pub mod lines;
pub mod machine;
pub mod memory;
pub mod pins;
pub mod priorities;
pub mod references;
pub mod reset_record;
pub mod ring;
pub mod safe_state;
pub mod stack;
pub mod tick;
pub mod uart;
pub mod watchdog;

// Links the logger; it has no items to name.
use defmt_rtt as _;

defmt::timestamp!("{=u64:us}", embassy_time::Instant::now().as_micros());
