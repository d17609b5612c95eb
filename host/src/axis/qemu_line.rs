//! The line to an axis in QEMU, in lockstep: the axis runs while the tool waits, and stands while the tool thinks.

use std::io;
use std::time::Duration;

use leadscrew_client::Line;
use leadscrew_qemu::{Error, Guest, Lockstep, Start, build};

/// Ticks that an exchange lets pass: 5 ms at 1 kHz.
const TICKS_OF_EXCHANGE: u16 = 5;
/// Control rate by which the clock of the line goes, whatever the axis's is, Hz.
const TICK_HZ: f64 = 1000.0;

/// An instruction takes 2^3 = 8 ns, as on a real Cortex-M4F: at 16 ns the guest, which simulates its machine too, has
/// no time to learn an encoder beside it.
const SHIFT: u32 = 3;

/// The image that runs an axis on its link.
pub const IMAGE: (&str, &str) = ("linked", "firmware");

/// An axis in QEMU; it ends with its line.
pub struct QemuLine {
    lockstep: Lockstep,
    ticks: u64,
    /// Kept: QEMU is killed when it is dropped.
    _guest: Guest,
}

impl QemuLine {
    /// Starts the axis, built first if need be, as `prepare` wants it.
    ///
    /// # Errors
    /// QEMU or the target is not there, the image does not build, or the guest does not come up.
    pub fn start(prepare: impl FnOnce(Start) -> Start) -> Result<Self, Error> {
        let (bin, profile) = IMAGE;
        let start = prepare(Start::new(build(bin, profile)?).shift(SHIFT)).lockstep();
        let mut guest = start.start()?;
        let lockstep = guest.take_lockstep().ok_or(Error::NoExecutable {
            bin: bin.to_owned(),
        })?;
        Ok(Self {
            lockstep,
            ticks: 0,
            _guest: guest,
        })
    }
}

impl Line for QemuLine {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        let exchanged = self.lockstep.exchange(TICKS_OF_EXCHANGE, out);
        let (_, bytes) = exchanged.map_err(io::Error::other)?;
        received.extend(bytes);
        self.ticks += u64::from(TICKS_OF_EXCHANGE);
        Ok(Duration::from_secs_f64(self.ticks as f64 / TICK_HZ))
    }

    fn name(&self) -> String {
        "qemu".to_owned()
    }

    fn is_lockstep(&self) -> bool {
        true
    }
}
