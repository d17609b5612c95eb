//! The controller that most retrofits use, to compare with: LinuxCNC's `pid` on hostmot2's encoder.
//!
//! ```text
//! command of the tick to come ──────────────┐
//! count ──────────────────────────► feedback ├─► law ─► output, d/s ─► ±10 V
//! last edges of two ticks ─► feedback-deriv ┘
//! ```
//!
//! [`law`] is the law by its manual page; [`mod@bench`] feeds it as LinuxCNC would, on the simulated machine; [`relay`]
//! tunes it as its own autotuner does, [`hand`] as well as it can be tuned.

pub mod bench;
pub mod hand;
pub mod law;
pub mod margins;
pub mod relay;
pub mod tunings;

pub use self::law::{Pid, PidInputs, PidParams};
