//! A serial port.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use serial2::SerialPort;

use super::{Line, PATIENCE, WRITE_PATIENCE, read};

/// Baud rate of a serial port unless another one is asked for: the rate of the boards.
pub const DEFAULT_BAUD: u32 = 921_600;

/// A serial port with 8 data bits, no parity, one stop bit and no flow control. Its clock is the computer's.
#[derive(Debug)]
pub struct SerialLine {
    port: SerialPort,
    name: String,
    opened: Instant,
}

impl SerialLine {
    /// Opens the port at `path` with `baud` bits a second.
    ///
    /// # Errors
    /// Of the system: there is none, it is in use, or may not be opened.
    pub fn open(path: &Path, baud: u32) -> io::Result<Self> {
        let port = SerialPort::open(path, baud)?;
        #[cfg(unix)]
        lock(&port)?;
        Self::over(port, path.display().to_string())
    }

    fn over(mut port: SerialPort, name: String) -> io::Result<Self> {
        port.set_read_timeout(PATIENCE)?;
        port.set_write_timeout(WRITE_PATIENCE)?;
        // What lay in the system's buffers belongs to whoever had the port before.
        port.discard_buffers()?;
        Ok(Self {
            port,
            name,
            opened: Instant::now(),
        })
    }

    /// The serial ports of this computer, by name.
    #[must_use]
    pub fn ports() -> Vec<String> {
        let found = SerialPort::available_ports().unwrap_or_default();
        let mut ports: Vec<_> = found
            .into_iter()
            .map(|port| port.display().to_string())
            .collect();
        ports.sort();
        ports
    }
}

/// Keeps other tools from the port, as long as it is open: of an answer each would have a part. Other systems do so
/// by themselves.
#[cfg(unix)]
fn lock(port: &SerialPort) -> io::Result<()> {
    use std::fs::{File, TryLockError};
    use std::os::fd::AsFd as _;

    // A lock belongs to what was opened, of which this is another name.
    let file = File::from(port.as_fd().try_clone_to_owned()?);
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(io::Error::new(
            io::ErrorKind::ResourceBusy,
            "another program has it",
        )),
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

impl Line for SerialLine {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        if !out.is_empty() {
            self.port.write_all(out)?;
        }
        read(received, |buffer| self.port.read(buffer))?;
        Ok(self.opened.elapsed())
    }

    fn name(&self) -> String {
        self.name.clone()
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn bytes_pass_both_ways_and_silence_is_no_error() {
        let (here, there) = SerialPort::pair().unwrap();
        let mut line = SerialLine::over(here, "pair".to_owned()).unwrap();
        let mut received = Vec::new();
        let before = line.exchange(&[], &mut received).unwrap();
        assert!(received.is_empty());

        // Zeros, line ends and control characters are bytes like others.
        let all: Vec<u8> = (0..=255).collect();
        let mut buffer = vec![0; 256];
        line.exchange(&all, &mut received).unwrap();
        there.read_exact(&mut buffer).unwrap();
        assert_eq!(buffer, all);
        there.write_all(&all).unwrap();
        while received.len() < all.len() {
            assert!(line.exchange(&[], &mut received).unwrap() >= before);
        }
        assert_eq!(received, all);

        drop(there);
        let gone = (0..100).any(|_| line.exchange(&[0], &mut received).is_err());
        assert!(gone);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_port_has_one_user() {
        use std::os::fd::AsRawFd as _;

        let (_here, there) = SerialPort::pair().unwrap();
        let path = std::fs::read_link(format!("/proc/self/fd/{}", there.as_raw_fd())).unwrap();
        let first = SerialLine::open(&path, 115_200).unwrap();
        let error = SerialLine::open(&path, 115_200).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::ResourceBusy, "{error}");
        drop(first);
        SerialLine::open(&path, 115_200).unwrap();
    }
}
