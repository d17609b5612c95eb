//! Talks to an axis from a computer: connect, enable, move, read.
//!
//! ```no_run
#![doc = include_str!("../examples/move.rs")]
//! ```
//!
//! ```text
//! Axis (mm, mm/min) ─► Connection (one request at a time, repeats, control lease) ─► Line (bytes, and the clock)
//! ```
//!
//! [`Port`] is the address that people write and opens the [`Line`]: a serial port or TCP. Others, as a simulated axis
//! has them, implement [`Line`]; its clock is the only one here, so that with a simulated one every run is
//! the same. The protocol is that of [`leadscrew::protocol`], specified in `docs/wire-format.md`.
//!
//! Who is connected holds the control lease only as long as it is renewed: the axis stops when its tool falls silent. All
//! that waits here renews it.
#![forbid(unsafe_code)]

mod axis;
mod connection;
mod error;
mod identity;
mod line;
mod options;
mod port;
mod recording;
mod scale;
mod status;

pub use axis::{
    Axis, ExperimentPhase, ExperimentStatus, FaultPage, Kind, LastReset, Learned, LearningPhase,
    LearningStatus, Live, Parameter, ProbeStatus, Records, Samples, ScopePhase, ScopeStatus,
    Stored, TickCounters, Touch, Value,
};
pub use connection::{Connection, Sample};
pub use error::{Error, Refused};
pub use identity::Identity;
pub use line::noisy;
pub use line::{DEFAULT_BAUD, Line, SerialLine, TcpLine};
pub use options::{Options, Timing};
pub use port::Port;
pub use recording::Recording;
pub use scale::{Physical, Scale};
pub use status::{LinkStatistics, Losses, Status};
