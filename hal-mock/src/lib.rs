//! The simulated machine on the other side of the seam: `no_std`, seeded, the same bits everywhere.
//!
//! ```text
//! command ─► drive ─► shaft ─┬─► encoder ─► Capture ─► faults ─► Capture
//!                            ├─► tachogenerator
//!                            └─► carriage (truth)
//! ```
//!
//! Floating point uses the four basic operations only while it runs, which give the same bits on every
//! machine; edges are found in integers. Units inside are d and ticks, as in the core; parameters are
//! physical.

#![no_std]
#![forbid(unsafe_code)]

pub mod arc;
pub mod board;
pub mod carriage;
pub mod disc;
pub mod drive;
pub mod encoder;
pub mod faults;
pub mod flash;
pub mod invariants;
pub mod learning;
pub mod machine;
pub mod play;
mod random;
pub mod scenario;
pub mod scene;
mod slip;
pub mod spindle;
pub mod tachogenerator;
pub mod touching;
pub mod trace;
mod track;
mod wave;
