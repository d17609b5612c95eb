//! How well an axis follows: moves, rest, creep, carriage and threads, beside LinuxCNC's `pid` on the same machines.

pub mod axis;
pub mod error;
pub mod linuxcnc;
pub mod scene;
pub mod trace;

pub use self::error::TrackingError;
