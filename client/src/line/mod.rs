//! Carriers of bytes, each with a clock of its own.

pub mod noisy;
mod serial;
mod tcp;

use std::io;
use std::time::Duration;

pub use serial::{DEFAULT_BAUD, SerialLine};
pub use tcp::TcpLine;

/// Longest time that a real line waits for bytes in one exchange.
const PATIENCE: Duration = Duration::from_millis(5);
/// Longest time that a real line waits for room to write.
const WRITE_PATIENCE: Duration = Duration::from_millis(500);
/// Most bytes taken in one exchange: a line that never falls silent does not keep the tool from its clock.
const MOST: usize = 64 * 1024;

/// A carrier of bytes with its own clock.
///
/// The client knows no other time than that of its line. Behind a serial port it is the computer's; a simulated axis, or
/// one that runs in lockstep, counts its own, and with it timeouts, repeats and renewals of the lease come out the
/// same in every run.
pub trait Line {
    /// Writes all of `out`, lets a little time pass, and appends what came to `received`: nothing, a part of a frame, or
    /// many. Gives the time on the line's clock since it was opened.
    ///
    /// An exchange waits for bytes some 5 ms at the longest. The clock never goes back, and with empty `out` and nothing
    /// received it goes on, else the client would wait for ever.
    ///
    /// # Errors
    /// Of the line: it is gone, the other side has closed it, it takes no bytes.
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration>;

    /// What it is called, for messages: the port.
    fn name(&self) -> String;

    /// True if the axis stands still between exchanges, as one in lockstep does: a tool may then compute for as long as it
    /// likes, and no lease lapses meanwhile.
    fn is_lockstep(&self) -> bool {
        false
    }
}

impl<L: Line + ?Sized> Line for Box<L> {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        (**self).exchange(out, received)
    }

    fn name(&self) -> String {
        (**self).name()
    }

    fn is_lockstep(&self) -> bool {
        (**self).is_lockstep()
    }
}

/// One read of a line that waits for bytes a short while; what came in the meantime is enough.
fn read(
    received: &mut Vec<u8>,
    mut read: impl FnMut(&mut [u8]) -> io::Result<usize>,
) -> io::Result<()> {
    let mut buffer = [0; 4096];
    let before = received.len();
    loop {
        match read(&mut buffer) {
            Ok(0) => {
                let closed = "the other side has closed the line";
                return Err(io::Error::new(io::ErrorKind::UnexpectedEof, closed));
            }
            Ok(count) => received.extend_from_slice(buffer.get(..count).unwrap_or_default()),
            Err(error) => match error.kind() {
                io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock => return Ok(()),
                io::ErrorKind::Interrupted => {}
                _ => return Err(error),
            },
        }
        let taken = received.len() - before;
        // A full buffer says that there may be more at once.
        if taken > 0 && (!taken.is_multiple_of(buffer.len()) || taken >= MOST) {
            return Ok(());
        }
    }
}
