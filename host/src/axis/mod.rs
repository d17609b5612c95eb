//! A real axis, or one in QEMU or in this process, behind the tool's port, and the guided procedures on it.
//!
//! The axis runs bounded experiments and moves, and records them; all that is computed of them is computed here.
//! Nothing here asks or prints: whoever calls gives a [`Guide`] where a person has to decide.

pub mod backup;
pub mod bode;
mod calm;
pub mod fault_report;
mod follow;
mod guide;
mod identify;
pub mod jog;
mod learn_encoder;
mod offset;
mod open;
mod procedure_error;
mod qemu_line;
mod room;
pub mod scope;
pub mod script;
pub mod serve;
mod settings;
pub mod setup;
pub mod telemetry;
mod tune;
pub mod values;

pub use follow::{Follows, TestMove, follow};
pub use guide::Guide;
pub use identify::{IdentifiedAxis, identify, prove_sign};
pub use learn_encoder::{Feeds, LearnedEncoder, Ripple, forget_learning, keep_map, learn_encoder};
pub use offset::{Drift, NulledOffset, null_offset};
pub use open::{PortArgs, flash, machine, open, port, simulated};
pub use procedure_error::ProcedureError;
pub use qemu_line::{IMAGE as QEMU_IMAGE, QemuLine};
pub use room::Room;
pub use settings::{Change, Setting, apply, differences, read_settings};
pub use tune::{Tuning, counts_on, followed_now, tune};
