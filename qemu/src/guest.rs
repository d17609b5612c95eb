use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::os::fd::{AsRawFd, OwnedFd};
use std::path::{Path, PathBuf};
use std::process::ExitStatus;
use std::time::{Duration, Instant};
use std::{path, thread};

use rustix::io::{FdFlags, fcntl_setfd};

use crate::call::Call;
use crate::files::RunFiles;
use crate::lockstep::Lockstep;
use crate::process::Process;
use crate::{Error, LogLine};

/// Wall time for QEMU to open its pseudo-terminals.
const UP: Duration = Duration::from_secs(20);
const POLL: Duration = Duration::from_millis(5);
const LINK: usize = 0;
const MODBUS: usize = 1;

/// What a UART of the guest is wired to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// A port of 127.0.0.1 for one client at a time.
    Tcp {
        /// The port; 0 for any that is free.
        port: u16,
    },
    /// A pseudo-terminal: a serial port for any program.
    Pty,
}

/// Where a client finds a UART of the guest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Endpoint {
    /// A socket.
    Tcp(SocketAddr),
    /// A terminal, in raw mode.
    Pty(PathBuf),
}

/// How to start a guest that runs until it is told to end, or killed.
#[derive(Clone, Debug)]
pub struct Start {
    image: PathBuf,
    shift: u32,
    args: Vec<String>,
    is_paced: bool,
    uarts: [Option<Carrier>; 2],
    is_in_lockstep: bool,
}

/// A guest that runs; it is killed when this is dropped.
#[derive(Debug)]
pub struct Guest {
    image: PathBuf,
    process: Process,
    files: RunFiles,
    endpoints: [Option<Endpoint>; 2],
    lockstep: Option<Lockstep>,
}

impl Start {
    /// A guest at shift 4 without arguments, nothing on its UARTs, as fast as it goes.
    #[must_use]
    pub fn new(image: PathBuf) -> Self {
        Self {
            image,
            shift: 4,
            args: Vec::new(),
            is_paced: false,
            uarts: [None; 2],
            is_in_lockstep: false,
        }
    }

    /// Sets the virtual time of an instruction to 2^`shift` ns; 0 to [`LARGEST_SHIFT`](crate::LARGEST_SHIFT).
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

    /// Gives the guest a flash image, which it makes if the file is not there. Its path must not have spaces.
    #[must_use]
    pub fn flash(self, path: &Path) -> Self {
        let path = path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.arg(format!("flash={}", path.display()))
    }

    /// Never ahead of the wall: for people, who live there. How far the computer keeps up is another matter.
    #[must_use]
    pub fn paced(mut self) -> Self {
        self.is_paced = true;
        self
    }

    /// Wires UART 0, the link.
    #[must_use]
    pub fn link(mut self, carrier: Carrier) -> Self {
        self.uarts[LINK] = Some(carrier);
        self
    }

    /// Wires UART 1, Modbus.
    #[must_use]
    pub fn modbus(mut self, carrier: Carrier) -> Self {
        self.uarts[MODBUS] = Some(carrier);
        self
    }

    /// Carries the link in lockstep, in place of UART 0. While the host has its turn QEMU serves nothing else.
    #[must_use]
    pub fn lockstep(mut self) -> Self {
        self.is_in_lockstep = true;
        self
    }

    /// Starts QEMU; in lockstep the guest is up when this returns, else it soon will be.
    ///
    /// # Errors
    /// A port is taken, a file or QEMU itself is not there, or the guest refused its command line.
    pub fn start(&self) -> Result<Guest, Error> {
        let files = RunFiles::new()?;
        let mut words = self.args.clone();
        let lockstep = if self.is_in_lockstep {
            words.push(format!("lockstep={}", files.folder().display()));
            Some(Lockstep::new(files.folder())?)
        } else {
            None
        };
        let sockets = [listen(self.uarts[LINK])?, listen(self.uarts[MODBUS])?];
        let options = [LINK, MODBUS].map(|uart| match self.uarts[uart] {
            Some(Carrier::Pty) => Some("pty".to_owned()),
            _ => sockets[uart].as_ref().map(Socket::options),
        });
        let call = Call {
            image: self.image.clone(),
            shift: self.shift,
            is_paced: self.is_paced,
            words,
            uarts: options.to_vec(),
        };
        let process = Process::new(call.spawn(&files)?);
        let mut guest = Guest {
            image: self.image.clone(),
            process,
            files,
            endpoints: sockets.map(|socket| socket.map(|socket| Endpoint::Tcp(socket.address))),
            lockstep,
        };
        guest.come_up(self).map_err(|error| guest.explain(error))?;
        Ok(guest)
    }
}

impl Guest {
    /// Where UART 0, the link, is to be found.
    #[must_use]
    pub fn link(&self) -> Option<&Endpoint> {
        self.endpoints[LINK].as_ref()
    }

    /// Where UART 1, Modbus, is to be found.
    #[must_use]
    pub fn modbus(&self) -> Option<&Endpoint> {
        self.endpoints[MODBUS].as_ref()
    }

    /// The line in lockstep, once.
    pub fn take_lockstep(&mut self) -> Option<Lockstep> {
        self.lockstep.take()
    }

    /// What the guest has logged so far.
    ///
    /// # Errors
    /// The log cannot be read or decoded.
    pub fn log(&self) -> Result<Vec<LogLine>, Error> {
        self.files.log(&self.image)
    }

    /// The same, as it came: equal bytes mean equal runs.
    ///
    /// # Errors
    /// The log cannot be read.
    pub fn log_bytes(&self) -> Result<Vec<u8>, Error> {
        self.files.log_bytes()
    }

    /// What QEMU itself had to say so far.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn stderr(&self) -> Result<String, Error> {
        self.files.stderr.read_text()
    }

    /// How QEMU ended, if it has.
    ///
    /// # Errors
    /// The system does not tell.
    pub fn ended(&self) -> Result<Option<ExitStatus>, Error> {
        self.process.ended().map_err(Error::Qemu)
    }

    /// Waits for the guest to end by itself; [`Error::Timeout`] leaves it running.
    ///
    /// # Errors
    /// It has not ended in time, or a signal ended it.
    pub fn wait(&self, timeout: Duration) -> Result<i32, Error> {
        let status = self.process.wait(timeout).map_err(Error::Qemu)?;
        let Some(status) = status else {
            return Err(Error::Timeout {
                after: timeout,
                log: self.log()?,
            });
        };
        status.code().ok_or(Error::Signal {
            stderr: self.files.stderr.read_text()?,
        })
    }

    /// A power cut: nothing of the guest runs any more. Its flash image is as it was at that moment.
    ///
    /// # Errors
    /// The system refuses.
    pub fn kill(&mut self) -> Result<(), Error> {
        self.process.kill().map(drop).map_err(Error::Qemu)
    }

    fn come_up(&mut self, start: &Start) -> Result<(), Error> {
        for uart in [LINK, MODBUS] {
            if start.uarts[uart] == Some(Carrier::Pty) {
                self.endpoints[uart] = Some(Endpoint::Pty(self.terminal(uart)?));
            }
        }
        match &mut self.lockstep {
            Some(lockstep) => lockstep.begin(self.process.clone()),
            None => Ok(()),
        }
    }

    /// The pseudo-terminal of a UART, once QEMU has told of it.
    fn terminal(&self, uart: usize) -> Result<PathBuf, Error> {
        let started = Instant::now();
        loop {
            let ended = self.ended()?;
            if let Some(path) = self.files.pty(&format!("uart{uart}"))? {
                return Ok(path);
            }
            if let Some(status) = ended {
                return Err(Error::Ended { status });
            }
            if started.elapsed() > UP {
                return Err(Error::NoTerminal { after: UP });
            }
            thread::sleep(POLL);
        }
    }

    /// Says what a guest that has not come up left behind.
    fn explain(&self, error: Error) -> Error {
        let Error::Ended { status } = error else {
            return error;
        };
        Error::NotUp {
            status,
            log: self.log().unwrap_or_default(),
            stderr: self.files.stderr.read_text().unwrap_or_default(),
        }
    }
}

impl Drop for Guest {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.process.kill();
    }
}

/// A socket that listens already when QEMU inherits it: nobody can take the port in between.
struct Socket {
    descriptor: OwnedFd,
    address: SocketAddr,
}

impl Socket {
    /// Options of QEMU's chardev.
    fn options(&self) -> String {
        let number = self.descriptor.as_raw_fd();
        format!("socket,fd={number},server=on,wait=off")
    }
}

fn listen(carrier: Option<Carrier>) -> Result<Option<Socket>, Error> {
    let Some(Carrier::Tcp { port }) = carrier else {
        return Ok(None);
    };
    let refused = |source| Error::Port { port, source };
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(refused)?;
    let address = listener.local_addr().map_err(refused)?;
    let descriptor = OwnedFd::from(listener);
    // Another QEMU that is started at this moment inherits it too, and does nothing with it.
    fcntl_setfd(&descriptor, FdFlags::empty()).map_err(|error| refused(error.into()))?;
    Ok(Some(Socket {
        descriptor,
        address,
    }))
}
