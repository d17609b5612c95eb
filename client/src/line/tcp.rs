//! A TCP stream.

use std::io::{self, Read as _, Write as _};
use std::net::{TcpStream, ToSocketAddrs as _};
use std::time::{Duration, Instant};

use super::{Line, PATIENCE, WRITE_PATIENCE, read};

/// Longest time to wait for a connection.
const CONNECT_PATIENCE: Duration = Duration::from_secs(3);

/// A TCP stream. Its clock is the computer's.
#[derive(Debug)]
pub struct TcpLine {
    stream: TcpStream,
    name: String,
    opened: Instant,
}

impl TcpLine {
    /// Connects to `address`, as `host:port`.
    ///
    /// # Errors
    /// Of the system: no such host, nobody listens there, no answer within 3 s.
    pub fn connect(address: &str) -> io::Result<Self> {
        let mut last = None;
        for candidate in address.to_socket_addrs()? {
            match TcpStream::connect_timeout(&candidate, CONNECT_PATIENCE) {
                Ok(stream) => return Self::of(stream, address),
                Err(error) => last = Some(error),
            }
        }
        Err(last.unwrap_or_else(|| io::Error::new(io::ErrorKind::NotFound, "no such host")))
    }

    fn of(stream: TcpStream, address: &str) -> io::Result<Self> {
        // Requests are small and waited for: none is to be held back for the next.
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(WRITE_PATIENCE))?;
        Ok(Self {
            stream,
            name: format!("tcp:{address}"),
            opened: Instant::now(),
        })
    }
}

impl Line for TcpLine {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        self.stream.write_all(out)?;
        read(received, |buffer| self.stream.read(buffer))?;
        Ok(self.opened.elapsed())
    }

    fn name(&self) -> String {
        self.name.clone()
    }
}
