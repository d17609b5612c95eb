//! How well an axis follows: moves, rest and creep, beside LinuxCNC's `pid` on the same machines.
//!
//! ```text
//! scene: machine, move ─► axis: ours ─────────┐
//!                      └► linuxcnc: the peer ─┴─► trace: what is read off ─► figures ─► text, JSON
//! ```
//!
//! The following error is setpoint less the true position of the encoder's shaft, of the worst of five encoders.

pub mod axis;
mod error;
mod figures;
pub mod linuxcnc;
pub mod scene;
mod table;
mod text;
pub mod trace;
mod tuned;

pub use self::error::TrackingError;
pub use self::figures::{CreepRow, Figures, Judged, MoveRow, PeerGains, PeerRow};
pub use self::table::{SEEDS, figures, setpoints};
