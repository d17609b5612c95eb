//! Runs board images in QEMU, repeatably.
//!
//! Time in the guest is a count of instructions (`-icount`): at shift N one instruction takes 2^N ns,
//! so two runs of one image with the same arguments give the same log to the byte, whatever else the
//! computer does. Shift 3 (8 ns) is nearest to a real Cortex-M4F, and takes about 3 s of wall time a
//! virtual second; 4 to 6 are faster and coarser.
//!
//! ```no_run
//! # fn main() -> Result<(), leadscrew_qemu::Error> {
//! let image = leadscrew_qemu::build("axis", "firmware")?;
//! let output = leadscrew_qemu::Run::new(image).arg("tick-hz=2500").run()?;
//! assert_eq!(output.exit_code, 0, "{output}");
//! # Ok(())
//! # }
//! ```
//!
//! [`Run`] goes to the end of a program. A [`Guest`] runs until it is told to end: its UARTs are on sockets or
//! pseudo-terminals, or its link is a [`Lockstep`] line.
//!
//! ```no_run
//! # fn main() -> Result<(), leadscrew_qemu::Error> {
//! let image = leadscrew_qemu::build("linked", "firmware")?;
//! let mut guest = leadscrew_qemu::Start::new(image).lockstep().start()?;
//! let mut line = guest.take_lockstep().expect("it is in lockstep");
//! // The axis gets these bytes, runs ten ticks, and says what it has to say.
//! let (ticks, bytes) = line.exchange(10, b"\x00")?;
//! # let _ = (ticks, bytes);
//! guest.kill()?;
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]

mod call;
mod error;
mod files;
mod guest;
mod image;
mod lockstep;
mod log;
mod process;
mod run;
mod sections;

pub use error::Error;
pub use guest::{Carrier, Endpoint, Guest, Start};
pub use image::{BOARD, TARGET, build};
pub use lockstep::{Lockstep, MOST_BYTES};
pub use log::{LogLine, decode};
pub use run::{LARGEST_SHIFT, Output, QEMU, Run};
pub use sections::Sections;
