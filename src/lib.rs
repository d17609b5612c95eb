//! Motion control of one machine-tool axis with a quadrature encoder, in fixed point.
//!
//! ```text
//! setpoint ─► compensation ─────────┐
//! (trajectory, step/dir,            ▼
//!  gearing, thread, analog)     ┌─────────┐      ┌────────────┐     ┌────────┐
//! encoder ─► capture ─► edges ─►│estimator│ ───► │ controller │ ──► │ output │ ──► drive ±10 V
//!  A B Z     count +    (map)   └─────────┘      │ PID+FF     │     │ limits │
//!  probe     edge times              │           └────────────┘     └────────┘
//!  home                              └──────────► supervisor (may stop everything) ──► enable, brake, faults
//!                     tachogenerator ─► check     telemetry ◄── every stage
//! ```
//!
//! Read in the order of the path: [`hal`] is the seam to a board, [`quadrature`] decodes where no
//! hardware does, [`capture`] unwraps, [`edges`] says where the shaft was and when, by [`encoder_map`]
//! where the encoder's own errors are known, [`estimator`] finds velocity and acceleration with their
//! [`uncertainty`], [`setpoint`] says where to be, [`compensation`] what the screw makes of it, [`controller`] what to
//! do about it, [`output`] limits it, [`supervisor`] says whether any of it may be, [`telemetry`] tells of it. [`axis`]
//! puts them together into one pure step; [`params`] makes its configuration from physical units, by the conversions
//! in [`units`]; [`settings`] names every value of them.
//!
//! Beside the path, [`homing`] finds where the axis counts from, [`probe`] where a surface is, [`identification`] what its drive does, and
//! [`tachogenerator`] checks the encoder by a second sensor. Outside the tick, [`setpoint::planner`] plans moves,
//! [`calibration`] learns where the encoder's edges really lie, [`tuning`] finds the loop's parameters, and [`protocol`]
//! lets a person at a laptop ask for all of it. Right behind the step, [`scope`] records what that person wants to see.
//!
//! The core is `no_std`, allocates nothing, uses no floating point in the tick and does not panic:
//! counters wrap by type and are unwrapped in one place, everything else saturates or is bounded by
//! an argument written beside it. Sums that are so bounded use wrapping operations, which cannot panic.
#![no_std]
#![forbid(unsafe_code)]
#![deny(
    clippy::arithmetic_side_effects,
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::unwrap_used
)]
#![cfg_attr(
    test,
    allow(
        clippy::arithmetic_side_effects,
        clippy::indexing_slicing,
        clippy::unwrap_used
    )
)]

pub mod axis;
pub mod calibration;
pub mod capture;
pub mod compensation;
pub mod controller;
pub mod edges;
pub mod encoder_map;
pub mod estimator;
pub mod hal;
pub mod homing;
pub mod identification;
mod narrowing;
pub mod output;
pub mod parameter_table;
pub mod params;
pub mod probe;
pub mod protocol;
pub mod quadrature;
pub mod scope;
pub mod setpoint;
pub mod settings;
pub mod supervisor;
pub mod tachogenerator;
pub mod telemetry;
pub mod tuning;
pub mod uncertainty;
pub mod units;
