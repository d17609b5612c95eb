//! Firmware shared by all boards: what happens in the control tick, what leaves it, who reports it.
//!
//! ```text
//!                       Request ─► heapless queue ─┐
//! (thread mode)                                    ▼
//!                    timer interrupt ─► tick::Runtime<AxisControl>
//!                     (the board's)       counts late, overlong
//!                                                  │ Record
//! telemetry::run ◄────── heapless queue ◄──────────┘
//! (thread mode, defmt)   one producer, one consumer; Ready is signalled by another interrupt
//! ```
//!
//! The tick uses no waker, no critical section and no logger; a board supplies the interrupts.
#![no_std]
#![forbid(unsafe_code)]

pub mod axis_control;
pub mod captures;
pub mod link;
pub mod modbus;
pub mod options;
pub mod queues;
pub mod report;
pub mod store;
pub mod telemetry;
pub mod tick;
