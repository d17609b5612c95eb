//! Firmware shared by all boards: what happens in the control tick, what leaves it, who reports it.
//!
//! ```text
//! thread mode                                  timer interrupt (the board's)
//!   bytes ─► link::Link ─── requests, settings, scopes ───► tick::Runtime<AxisControl>
//!            service, store, learning                         counts late, overlong
//!   bytes ◄─ modbus::Modbus     ◄── Report of every tick, outcomes, samples, captures ──┘
//!
//! telemetry::run: follows the reports of a run that has no link
//! ```
//!
//! All arrows are queues of one producer and one consumer ([`queues`]); memory that both sides work with goes through
//! them as a value. An interrupt that the tick pends wakes thread mode.
//!
//! The tick uses no waker, no critical section and no logger; a board supplies the interrupts.
#![no_std]
#![forbid(unsafe_code)]

pub mod axis_control;
pub mod captures;
pub mod converter;
pub mod edge_ring;
pub mod input_filter;
pub mod link;
pub mod modbus;
pub mod options;
pub mod queues;
pub mod report;
pub mod store;
pub mod telemetry;
pub mod tick;
pub mod tick_period;
