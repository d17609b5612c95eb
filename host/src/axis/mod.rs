//! A real axis, or one in QEMU or in this process, behind the tool's port.

pub mod backup;
pub mod fault_report;
pub mod jog;
mod open;
mod qemu_line;
pub mod scope;
pub mod script;
pub mod serve;
pub mod telemetry;
pub mod values;

pub use open::{PortArgs, flash, machine, open, port, simulated};
pub use qemu_line::IMAGE as QEMU_IMAGE;
