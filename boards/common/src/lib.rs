//! What the boards have in common below `leadscrew_app`: it holds for any chip, but is not free of `unsafe`, or of interrupts.
//!
//! ```text
//! isr_cell        state of an interrupt handler
//! line            bytes between an interrupt and thread mode
//! paint           how far a stack was used
//! serve           thread mode: reports, the link's bytes, Modbus, a restart
//! ```
//!
//! No chip, no clock and no executor is chosen here.
#![no_std]

pub mod isr_cell;
pub mod line;
pub mod paint;
pub mod serve;
