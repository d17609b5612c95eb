//! The axis of the image with its machine, as a tool talks to it: a [`Line`] in virtual time.

use std::io;
use std::path::PathBuf;
use std::time::Duration;

use leadscrew_client::Line;

use crate::axis_machine::MachineHandle;
use crate::emulator::{Emulator, EmulatorError, Serial};
use crate::part::Part;
use crate::{CLOCK_HZ, Elf, MILLISECOND};

/// Time that an exchange lets pass.
const EXCHANGE: u64 = 5 * MILLISECOND;

/// There is no firmware to run.
#[derive(Debug)]
pub struct NoFirmware(PathBuf, String);

impl std::fmt::Display for NoFirmware {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{}: {}; build it: cargo build -p board-stm32f4 --target thumbv7em-none-eabihf --profile firmware",
            self.0.display(),
            self.1
        )
    }
}

impl std::error::Error for NoFirmware {}

/// The image that is flashed, from the target folder: that of `LEADSCREW_FIRMWARE`, or as cargo leaves it.
///
/// # Errors
/// It was not built, or is no ELF.
pub fn firmware() -> Result<Elf, NoFirmware> {
    let path = std::env::var_os("LEADSCREW_FIRMWARE").map_or_else(built, PathBuf::from);
    let content =
        std::fs::read(&path).map_err(|error| NoFirmware(path.clone(), error.to_string()))?;
    Elf::parse(&content).map_err(|error| NoFirmware(path, error.to_string()))
}

fn built() -> PathBuf {
    let workspace = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..");
    let target = std::env::var_os("CARGO_TARGET_DIR");
    let target = target.map_or_else(|| workspace.join("target"), PathBuf::from);
    target.join("thumbv7em-none-eabihf/firmware/firmware")
}

/// An axis with its machine.
pub struct EmulatedAxis {
    part: Part,
    elf: Elf,
    machine: MachineHandle,
}

impl EmulatedAxis {
    /// Flashes the image into a blank part and switches it on.
    ///
    /// # Errors
    /// The image does not fit, or cannot be emulated.
    pub fn new(elf: Elf, machine: MachineHandle) -> Result<Self, EmulatorError> {
        Self::with_flash(elf, Part::blank_flash(), machine)
    }

    /// Flashes the image into a part that keeps what else is in its flash.
    ///
    /// # Errors
    /// As of [`Self::new`].
    pub fn with_flash(
        elf: Elf,
        mut flash: Vec<u8>,
        machine: MachineHandle,
    ) -> Result<Self, EmulatorError> {
        elf.program(&mut flash)
            .map_err(|error| EmulatorError(error.to_string()))?;
        Ok(Self {
            part: Part::new(flash, MachineHandle::clone(&machine))?,
            elf,
            machine,
        })
    }

    /// The part.
    pub const fn part(&mut self) -> &mut Part {
        &mut self.part
    }

    /// Seconds since power-on.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.part.now() as f64 / CLOCK_HZ as f64
    }

    /// The image.
    #[must_use]
    pub const fn elf(&self) -> &Elf {
        &self.elf
    }

    /// The machine.
    #[must_use]
    pub const fn machine(&self) -> &MachineHandle {
        &self.machine
    }

    /// Lets time pass.
    ///
    /// # Errors
    /// The emulator cannot go on.
    pub fn run_ms(&mut self, milliseconds: u64) -> Result<(), EmulatorError> {
        self.run(milliseconds * MILLISECOND)
    }

    /// The same in clocks.
    ///
    /// # Errors
    /// The emulator cannot go on.
    pub fn run(&mut self, clocks: u64) -> Result<(), EmulatorError> {
        let until = self.part.now() + clocks;
        self.part.run_until(until)
    }
}

impl Line for EmulatedAxis {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        self.part.send(Serial::Link, out);
        self.run(EXCHANGE).map_err(io::Error::other)?;
        received.extend(self.part.receive(Serial::Link));
        Ok(Duration::from_secs_f64(self.seconds()))
    }

    fn name(&self) -> String {
        "emulated STM32F407".to_owned()
    }

    fn is_lockstep(&self) -> bool {
        true
    }
}
