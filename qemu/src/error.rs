use std::io;
use std::path::PathBuf;
use std::time::Duration;

use crate::log::LogLine;
use crate::{QEMU, TARGET};

/// Why an image could not be built or run; the message says what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// QEMU is not installed, or not on the path.
    #[error(
        "{QEMU} not found: run `cargo xtask setup`, or `apt-get install {QEMU}` on Debian and Ubuntu"
    )]
    NoQemu,
    /// The nested cargo could not be started.
    #[error("cannot start cargo to build `{bin}`: {source}")]
    NoCargo {
        /// The binary to build.
        bin: String,
        /// What the system said.
        source: io::Error,
    },
    /// The image does not build.
    #[error(
        "`{bin}` does not build for {TARGET} (target not installed? run `cargo xtask setup`):\n{stderr}"
    )]
    Build {
        /// The binary to build.
        bin: String,
        /// What cargo printed.
        stderr: String,
    },
    /// Cargo built, but named no executable.
    #[error("cargo named no executable for `{bin}`: the board crate has no such binary")]
    NoExecutable {
        /// The binary to build.
        bin: String,
    },
    /// A file of the run could not be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The image has no table of log messages, or one this decoder does not know.
    #[error("{}: cannot decode its log: {reason}", path.display())]
    Image {
        /// The image.
        path: PathBuf,
        /// What the decoder said.
        reason: String,
    },
    /// The image is no ELF file.
    #[error("{}: cannot read its sections: {reason}", path.display())]
    Sections {
        /// The image.
        path: PathBuf,
        /// What the reader said.
        reason: String,
    },
    /// QEMU could not be started or waited for.
    #[error("cannot run {QEMU}: {0}")]
    Qemu(io::Error),
    /// QEMU ended by itself before the guest logged anything.
    #[error("{QEMU} refused to run the image: {stderr}")]
    Refused {
        /// What QEMU printed.
        stderr: String,
    },
    /// The guest did not end in time; QEMU was killed.
    #[error("the guest did not end within {} s of wall time and was killed; its log:\n{}",
        .after.as_secs(), lines(.log))]
    Timeout {
        /// The time it was given.
        after: Duration,
        /// What it had logged.
        log: Vec<LogLine>,
    },
    /// A signal ended QEMU.
    #[error("{QEMU} was ended by a signal: {stderr}")]
    Signal {
        /// What QEMU printed.
        stderr: String,
    },
}

fn lines(log: &[LogLine]) -> String {
    let lines: Vec<_> = log.iter().map(ToString::to_string).collect();
    lines.join("\n")
}
