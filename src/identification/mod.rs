//! What the drive does with a command, found by small bounded experiments.
//!
//! ```text
//! Identification ─► Program ─► Axis::start_experiment ─► Experiment (in the tick: bounds, command) ─► output
//!       ▲ fits                                                │
//!       └──────────── Recorder (memory lent by the board) ◄───┘ position, command in force
//! ```
//!
//! First the sign is proved by open-loop pulses that grow until the axis moves; a wrong sign, or none, ends all.
//! Slow ramps then show what breaks the axis away, steps at two levels give a first model, and from it follow
//! steps at three levels, reversals and chirps that make the best of the window. A model of second order with
//! delay, dead time, offset, friction and a limit of acceleration is fitted to the positions ([`fit`]).
//!
//! What is in the tick ([`experiment`]) is integers; all else runs outside it, in floating point.

mod conclusion;
pub mod drive;
mod evidence;
pub mod experiment;
pub mod fit;
pub mod identified;
pub mod matrix;
mod plan;
pub mod procedure;
pub mod program;
pub mod recorder;
mod refusal;
mod seed;
mod stages;

pub use identified::{Figure, Identified, LargestAcceleration};
pub use plan::IdentifyParams;
pub use procedure::{Identification, Next};
pub use refusal::Refusal;
pub use stages::Stage;
