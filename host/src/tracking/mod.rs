//! How well an axis follows: moves, rest, creep, carriage and threads, beside LinuxCNC's `pid` on the same machines.
//!
//! ```text
//! scene: machine, move ─► axis: ours ─────────┐
//!                      └► linuxcnc: the peer ─┴─► trace: what is read off ─► figures ─► text, JSON
//! ```
//!
//! The following error is setpoint less the true position of the encoder's shaft, of the worst of five encoders.

pub mod axis;
mod carriage;
mod error;
mod figures;
pub mod linuxcnc;
pub mod ours;
pub mod scene;
mod table;
mod text;
mod threads;
pub mod trace;

pub use self::error::TrackingError;
pub use self::figures::{
    CarriageRow, CreepRow, Figures, Judged, MoveRow, PeerGains, PeerRow, ThreadPass, Threads,
};
pub use self::ours::{Course, Rig, TrackingFigures, model_of, tuned_on};
pub use self::table::{SEEDS, figures, setpoints};
