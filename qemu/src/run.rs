use std::fmt;
use std::path::PathBuf;
use std::time::Duration;

use crate::call::{Call, file_uart};
use crate::files::{RunFile, RunFiles};
use crate::process::Process;
use crate::{Error, LogLine, decode};

/// The emulator, as it is called on the path and as Debian calls its package.
pub const QEMU: &str = "qemu-system-arm";
/// QEMU takes no larger one: 1 µs an instruction.
pub const LARGEST_SHIFT: u32 = 10;

/// One run of an image.
#[derive(Clone, Debug)]
pub struct Run {
    /// The ELF file; [`crate::build`] makes it.
    pub image: PathBuf,
    /// One instruction takes 2^shift ns of virtual time; 0 to [`LARGEST_SHIFT`].
    pub shift: u32,
    /// Words for the guest's command line.
    pub args: Vec<String>,
    /// Wall time after which the guest is killed.
    pub timeout: Duration,
}

/// What a run left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    /// The guest's exit code.
    pub exit_code: i32,
    /// The guest's log, decoded.
    pub log_lines: Vec<LogLine>,
    /// The same, as it came: equal bytes mean equal runs.
    pub log_bytes: Vec<u8>,
    /// What the guest sent on UART 0.
    pub uart: String,
    /// What QEMU itself had to say.
    pub stderr: String,
}

impl fmt::Display for Output {
    /// Log, UART and QEMU's words, for a person to read.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for line in &self.log_lines {
            writeln!(f, "{line}")?;
        }
        write!(f, "{}{}", self.uart, self.stderr)
    }
}

impl Run {
    /// A run at shift 3 without arguments, killed after two minutes.
    pub fn new(image: PathBuf) -> Self {
        Self {
            image,
            shift: 3,
            args: Vec::new(),
            timeout: Duration::from_secs(120),
        }
    }

    /// Sets the virtual time of an instruction to 2^`shift` ns; 0 to [`LARGEST_SHIFT`].
    #[must_use]
    pub fn shift(mut self, shift: u32) -> Self {
        self.shift = shift;
        self
    }

    /// Adds a word to the guest's command line; it must not have spaces.
    #[must_use]
    pub fn arg(mut self, word: impl Into<String>) -> Self {
        self.args.push(word.into());
        self
    }

    /// Sets the wall time after which the guest is killed.
    #[must_use]
    pub fn timeout(mut self, timeout: Duration) -> Self {
        self.timeout = timeout;
        self
    }

    /// Runs to the guest's exit.
    pub fn run(&self) -> Result<Output, Error> {
        let files = RunFiles::new()?;
        let uart = RunFile::new(files.folder(), "uart");
        let call = Call {
            image: self.image.clone(),
            shift: self.shift,
            is_paced: false,
            words: self.args.clone(),
            uarts: vec![Some(file_uart(&uart.path))],
        };
        let process = Process::new(call.spawn(&files)?);
        let status = process.wait(self.timeout);
        if !matches!(status, Ok(Some(_))) {
            process.kill().map_err(Error::Qemu)?;
        }
        let status = status.map_err(Error::Qemu)?;
        let log_bytes = files.log_bytes()?;
        let log_lines = decode(&self.image, &log_bytes)?;
        let Some(status) = status else {
            return Err(Error::Timeout {
                after: self.timeout,
                log: log_lines,
            });
        };
        let stderr = files.stderr.read_text()?;
        let Some(exit_code) = status.code() else {
            return Err(Error::Signal { stderr });
        };
        if exit_code != 0 && log_bytes.is_empty() && stderr.starts_with(QEMU) {
            return Err(Error::Refused { stderr });
        }
        Ok(Output {
            exit_code,
            log_lines,
            log_bytes,
            uart: uart.read_text()?,
            stderr,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_image_is_named() {
        let error = Run::new(PathBuf::from("/no/such/image")).run().unwrap_err();
        assert!(error.to_string().starts_with("/no/such/image: "), "{error}");
    }
}
