//! A real axis, or one in QEMU or in this process, behind the tool's port.

mod open;
mod qemu_line;
pub mod scope;
pub mod telemetry;

pub use open::{PortArgs, open};
