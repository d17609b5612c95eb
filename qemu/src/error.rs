use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitStatus;
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
    /// A word of the guest's command line has a space.
    #[error("`{word}`: the guest's command line cannot carry a space; use a path without one")]
    Word {
        /// The word.
        word: String,
    },
    /// The port cannot be listened on.
    #[error(
        "cannot listen on 127.0.0.1:{port}: {source}; give another port, or 0 for any free one"
    )]
    Port {
        /// The port asked for.
        port: u16,
        /// What the system said.
        source: io::Error,
    },
    /// QEMU ended before the guest had said what was waited for.
    #[error("the guest has ended ({status})")]
    Ended {
        /// How QEMU ended.
        status: ExitStatus,
    },
    /// QEMU ended before the guest was up.
    #[error("the guest has not come up ({status}); its log:\n{}\n{stderr}", lines(.log))]
    NotUp {
        /// How QEMU ended.
        status: ExitStatus,
        /// What the guest had logged.
        log: Vec<LogLine>,
        /// What QEMU printed.
        stderr: String,
    },
    /// QEMU has not told where its pseudo-terminal is.
    #[error("{QEMU} has not opened a pseudo-terminal within {} s of wall time", .after.as_secs())]
    NoTerminal {
        /// The time it was given.
        after: Duration,
    },
    /// The guest runs and does not come to its next barrier.
    #[error("the guest has not come to its next barrier within {} s of wall time", .after.as_secs())]
    NoBarrier {
        /// The time it was given.
        after: Duration,
    },
    /// More bytes than a barrier brings to the guest.
    #[error("{found} bytes are too many for one exchange: send {most} at most")]
    TooLong {
        /// How many were to be sent.
        found: usize,
        /// How many there may be.
        most: usize,
    },
    /// A FIFO could not be made or used.
    #[error("cannot keep in step with the guest: {0}")]
    Fifo(io::Error),
    /// A signal ended QEMU.
    #[error("{QEMU} was ended by a signal: {stderr}")]
    Signal {
        /// What QEMU printed.
        stderr: String,
    },
}

impl Error {
    pub(crate) fn file(path: &Path, source: io::Error) -> Self {
        Self::File {
            path: path.to_owned(),
            source,
        }
    }
}

fn lines(log: &[LogLine]) -> String {
    let lines: Vec<_> = log.iter().map(ToString::to_string).collect();
    lines.join("\n")
}
