//! A pseudo terminal with a unit behind it, for masters that are programs.

use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::os::fd::OwnedFd;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use leadscrew_app::modbus::{Config, Modbus};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode, OFlags, open};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

use crate::fake::{Fake, UNIT};

/// A unit that is served until this is dropped.
pub struct Served {
    /// What a master opens: a device, or host and port.
    pub address: String,
    pub panel: Arc<Mutex<Fake>>,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// Else the terminal hangs up when a master closes it.
    _kept: Option<OwnedFd>,
}

impl Drop for Served {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        let ended = self.thread.take().map(JoinHandle::join);
        assert!(ended.is_none_or(|ended| ended.is_ok()) || std::thread::panicking());
    }
}

/// Answers what comes through `read` (0 bytes: nothing now) by `write`.
fn serve(
    is_over: &AtomicBool,
    panel: &Mutex<Fake>,
    mut read: impl FnMut(&mut [u8]) -> usize,
    mut write: impl FnMut(&[u8]),
) {
    // A terminal and TCP keep no time between characters.
    let config = Config::serial(UNIT, 19_200).unwrap();
    let config = config.with_silence_us(50_000);
    let mut modbus = Modbus::new(config, panel.lock().unwrap().settings);
    let started = Instant::now();
    let mut buffer = [0; 64];
    while !is_over.load(Ordering::Relaxed) {
        let count = read(&mut buffer);
        let now_us = started.elapsed().as_micros() as u32;
        let mut panel = panel.lock().unwrap();
        modbus.receive(&buffer[..count], now_us, &mut *panel, &mut write);
        modbus.poll(now_us, &mut *panel, &mut write);
    }
}

fn served(
    address: String,
    panel: Fake,
    kept: Option<OwnedFd>,
    run: impl FnOnce(&AtomicBool, &Mutex<Fake>) + Send + 'static,
) -> Served {
    let panel = Arc::new(Mutex::new(panel));
    let is_over = Arc::new(AtomicBool::new(false));
    let (shown, told) = (panel.clone(), is_over.clone());
    Served {
        address,
        panel,
        is_over,
        thread: Some(std::thread::spawn(move || run(&told, &shown))),
        _kept: kept,
    }
}

/// On a pseudo terminal.
pub fn on_terminal(panel: Fake) -> Served {
    let near = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&near).unwrap();
    unlockpt(&near).unwrap();
    let address = ptsname(&near, Vec::new()).unwrap().into_string().unwrap();
    let flags = OFlags::RDWR | OFlags::NOCTTY;
    let far = open(address.as_str(), flags, Mode::empty()).unwrap();
    let mut raw = tcgetattr(&far).unwrap();
    raw.make_raw();
    tcsetattr(&far, OptionalActions::Now, &raw).unwrap();
    served(address, panel, Some(far), move |is_over, panel| {
        let read = |buffer: &mut [u8]| {
            let wait = Timespec {
                tv_sec: 0,
                tv_nsec: 5_000_000,
            };
            let mut waiting = [PollFd::new(&near, PollFlags::IN)];
            match poll(&mut waiting, Some(&wait)) {
                Ok(1..) => rustix::io::read(&near, buffer).unwrap(),
                _ => 0,
            }
        };
        serve(is_over, panel, read, |frame| {
            assert_eq!(rustix::io::write(&near, frame).unwrap(), frame.len());
        });
    })
}

/// On a TCP port, RTU frames as a serial server or QEMU gives them; for one connection.
pub fn on_tcp(panel: Fake) -> Served {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    served(address, panel, None, move |is_over, panel| {
        listener.set_nonblocking(true).unwrap();
        let stream = loop {
            match listener.accept() {
                Ok((stream, _)) => break stream,
                Err(_) if is_over.load(Ordering::Relaxed) => return,
                Err(_) => std::thread::sleep(Duration::from_millis(5)),
            }
        };
        stream.set_nonblocking(false).unwrap();
        let wait = Some(Duration::from_millis(5));
        stream.set_read_timeout(wait).unwrap();
        // An end or an error is silence: the master is gone.
        let read = |buffer: &mut [u8]| (&stream).read(buffer).unwrap_or(0);
        serve(is_over, panel, read, |frame| {
            (&stream).write_all(frame).unwrap();
        });
    })
}
