//! The simulated axis on a TCP port, in step with the wall clock.

use std::io::{self, Read as _, Write as _};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use leadscrew_client::Line as _;

use crate::simulated_axis::SimulatedAxis;

/// An axis that falls behind the clock by more than this does not catch up: tools would see it race.
const MOST_BEHIND: Duration = Duration::from_millis(200);

/// An axis behind a TCP port, for one client at a time: the latest.
pub struct Server {
    listener: TcpListener,
    client: Option<TcpStream>,
    axis: SimulatedAxis,
}

impl Server {
    /// Listens on an address.
    ///
    /// # Errors
    /// Of the system: it is taken, or not this computer's.
    pub fn listen(address: SocketAddr, axis: SimulatedAxis) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            listener,
            client: None,
            axis,
        })
    }

    /// Where it listens.
    ///
    /// # Errors
    /// Of the system.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Serves until it is interrupted.
    ///
    /// # Errors
    /// Of the axis, whose flash failed.
    pub fn run(&mut self, interrupted: &AtomicBool) -> io::Result<()> {
        let mut begin = Instant::now();
        let (mut to_axis, mut to_tool) = (Vec::new(), Vec::new());
        while !interrupted.load(Ordering::Relaxed) {
            self.accept();
            to_axis.clear();
            to_tool.clear();
            self.receive(&mut to_axis);
            let time = self.axis.exchange(&to_axis, &mut to_tool)?;
            self.send(&to_tool);
            let gone = begin.elapsed();
            if let Some(early) = time.checked_sub(gone) {
                thread::sleep(early);
            } else if gone.saturating_sub(time) > MOST_BEHIND {
                begin += gone.saturating_sub(time);
            }
        }
        Ok(())
    }

    /// Takes a new client in place of the one before: who sits before the axis now counts.
    fn accept(&mut self) {
        while let Ok((client, _)) = self.listener.accept() {
            // Replies are small and waited for.
            let is_set_up = client.set_nonblocking(true).is_ok();
            let _ = client.set_nodelay(true);
            self.client = Some(client).filter(|_| is_set_up);
        }
    }

    fn receive(&mut self, to_axis: &mut Vec<u8>) {
        let Some(client) = &mut self.client else {
            return;
        };
        let mut buffer = [0; 4096];
        match client.read(&mut buffer) {
            Ok(0) => self.client = None,
            Ok(count) => to_axis.extend_from_slice(buffer.get(..count).unwrap_or_default()),
            Err(error) if is_for_the_moment(&error) => {}
            Err(_) => self.client = None,
        }
    }

    /// Sends what there is room for; the rest is lost, as on a line that nobody reads.
    fn send(&mut self, bytes: &[u8]) {
        let Some(client) = &mut self.client else {
            return;
        };
        if let Err(error) = client.write_all(bytes)
            && !is_for_the_moment(&error)
        {
            self.client = None;
        }
    }
}

fn is_for_the_moment(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted
    )
}
