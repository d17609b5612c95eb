//! How well an axis follows: moves, rest, creep, carriage and threads, beside LinuxCNC's `pid` on the same machines.
//!
//! ```text
//! scene: machine ─► kit: maps, axes from cold ─► rig, runs: ours ────────┐
//!                └► linuxcnc: the peer ──────────────────────────────────┴─► trace ─► figures ─► text, JSON
//! ```
//!
//! The following error is setpoint less the true position of the encoder's shaft, of the worst of five encoders.
//! The axes are commissioned as on a real machine: the drive is identified by the product's own experiments, then tuned.

mod carriage;
mod course;
mod creep;
mod error;
mod figures;
mod identified;
mod kit;
pub mod linuxcnc;
mod moves;
mod peer;
mod rig;
mod runs;
pub mod scene;
mod table;
mod text;
mod threads;
pub mod trace;
mod tuned;

pub use self::course::{Course, TrackingFigures};
pub use self::error::TrackingError;
pub use self::figures::{
    CarriageRow, CreepRow, Figures, IdentifiedFigure, IdentifiedRow, Judged, MoveRow, PeerGains,
    PeerRow, ThreadPass, Threads,
};
pub use self::kit::SEEDS;
pub use self::moves::setpoints;
pub use self::rig::Rig;
pub use self::table::figures;
pub use self::tuned::{Cold, model_of, tuned_from_cold, tuned_on};
