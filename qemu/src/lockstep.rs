use std::io::{self, Read as _, Write as _};
use std::path::Path;
use std::time::{Duration, Instant};
use std::{fs, fs::File};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{CWD, Mode, mkfifoat};

use crate::Error;
use crate::process::Process;

/// Bytes that an exchange brings to the guest at most, as the board's `lockstep.rs` has it.
pub const MOST_BYTES: usize = 8 * 1024;
const HEADER: usize = 6;
/// How often to look whether QEMU still runs.
const LOOK: Duration = Duration::from_millis(50);
/// Wall time for a barrier: 65 535 ticks at 1 kHz take about two minutes.
const PATIENCE: Duration = Duration::from_secs(600);

/// The host's end of a line on which the guest stands still while the host has its turn: the run depends on the bytes
/// alone.
///
/// It may outlive its [`Guest`](crate::Guest), and then tells that it has ended.
#[derive(Debug)]
pub struct Lockstep {
    to_guest: File,
    from_guest: File,
    process: Option<Process>,
}

impl Lockstep {
    /// Makes the FIFOs in `folder`, for a guest to open.
    pub(crate) fn new(folder: &Path) -> Result<Self, Error> {
        let open = |name: &str| {
            let path = folder.join(name);
            mkfifoat(CWD, &path, Mode::RUSR | Mode::WUSR)?;
            // Both ways, so that opening waits for nobody and a guest that restarts finds the host still there.
            fs::OpenOptions::new().read(true).write(true).open(path)
        };
        Ok(Self {
            to_guest: open("to-guest").map_err(Error::Fifo)?,
            from_guest: open("to-host").map_err(Error::Fifo)?,
            process: None,
        })
    }

    /// Waits for the guest's first barrier, before its first tick.
    pub(crate) fn begin(&mut self, process: Process) -> Result<(), Error> {
        self.process = Some(process);
        self.barrier().map(drop)
    }

    /// Gives the guest `bytes` and lets it run for `ticks`, 1 or more; then the number of ticks that have run since its
    /// start, and what it sent. The axis counts its ticks from 0: it tells of one less.
    ///
    /// 0 ticks end the guest's program, which then is [`Error::Ended`].
    ///
    /// A tick that is smaller than the one before is that of a guest that has restarted.
    ///
    /// # Errors
    /// The guest has ended, by itself or because it was killed; or too many bytes.
    pub fn exchange(&mut self, ticks: u16, bytes: &[u8]) -> Result<(u32, Vec<u8>), Error> {
        if bytes.len() > MOST_BYTES {
            return Err(Error::TooLong {
                found: bytes.len(),
                most: MOST_BYTES,
            });
        }
        let mut message = ticks.to_le_bytes().to_vec();
        // MOST_BYTES is below 2¹⁶.
        message.extend((bytes.len() as u16).to_le_bytes());
        message.extend(bytes);
        // Far below what a FIFO holds, and the guest has emptied it at its last barrier.
        self.to_guest.write_all(&message).map_err(Error::Fifo)?;
        self.barrier()
    }

    fn barrier(&mut self) -> Result<(u32, Vec<u8>), Error> {
        let mut header = [0; HEADER];
        self.read(&mut header)?;
        let [a, b, c, d, low, high] = header;
        let mut bytes = vec![0; usize::from(u16::from_le_bytes([low, high]))];
        self.read(&mut bytes)?;
        Ok((u32::from_le_bytes([a, b, c, d]), bytes))
    }

    /// Reads as many bytes as `place` takes, or finds that QEMU does not run any more.
    fn read(&mut self, place: &mut [u8]) -> Result<(), Error> {
        let started = Instant::now();
        let mut done = 0;
        while done < place.len() {
            // Asked before the FIFO: what came before the end is still read.
            let ended = self.ended()?;
            if self.is_readable()? {
                match self.from_guest.read(&mut place[done..]) {
                    Ok(count) => done += count,
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                    Err(error) => return Err(Error::Fifo(error)),
                }
            } else if let Some(status) = ended {
                return Err(Error::Ended { status });
            } else if started.elapsed() > PATIENCE {
                return Err(Error::NoBarrier { after: PATIENCE });
            }
        }
        Ok(())
    }

    fn ended(&self) -> Result<Option<std::process::ExitStatus>, Error> {
        match &self.process {
            Some(process) => process.ended().map_err(Error::Qemu),
            None => Ok(None),
        }
    }

    /// Waits a while for bytes.
    fn is_readable(&self) -> Result<bool, Error> {
        let mut descriptors = [PollFd::new(&self.from_guest, PollFlags::IN)];
        let look = Timespec {
            tv_sec: 0,
            tv_nsec: LOOK.subsec_nanos().into(),
        };
        match poll(&mut descriptors, Some(&look)) {
            Ok(count) => Ok(count > 0),
            Err(rustix::io::Errno::INTR) => Ok(false),
            Err(error) => Err(Error::Fifo(error.into())),
        }
    }
}
