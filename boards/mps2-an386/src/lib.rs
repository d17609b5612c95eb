//! The board that QEMU models as `mps2-an386`: a Cortex-M4F at 25 MHz with CMSDK timers and UARTs.
//!
//! It has no encoder inputs and no drive: the machine is simulated in the guest, by an interrupt of
//! its own. All `unsafe` of the firmware is in this crate, each with its reason.
#![no_std]

pub mod carrier;
mod exit;
pub mod flash;
pub mod handoff;
pub mod instructions;
pub mod interrupts;
pub mod lockstep;
mod registers;
pub mod simulated;
pub mod time_driver;
pub mod timer;
pub mod uart;

pub use exit::{arguments, exit_failure, exit_success, restart};

// Links the logger; it has no items to name.
use defmt_semihosting as _;

/// Clock of all timers of the board, in Hz.
pub const CLOCK_HZ: u32 = 25_000_000;

defmt::timestamp!("{=u64:us}", time_driver::now_us());
