//! What stands between the machine and the axis besides the encoder: converter, drive lines, brake, switches,
//! wiring, and what may go wrong with each.
//!
//! ```text
//! Outputs ─► converter ─► wires ─► machine ─► encoder fault ─► wires ─► Capture ┐
//!        ─► brake ──────────────► (shaft)                                       ├► Inputs
//!        ─► enable ─► drive lines ─────────────────────────► Lines, readback ───┘
//!                          carriage ─► switches ──────────► Lines, home latch
//! ```

mod brake;
mod converter;
mod drive_lines;
mod switches;
mod touch_probe;

use core::ops::Range;

use leadscrew::axis::{Inputs, Outputs};
use leadscrew::hal::{Capture, Encoder as _, Latch, Lines, Reference};
use leadscrew::units::{AxisScale, Command, RangeError};

pub use self::brake::BrakeParams;
pub use self::converter::Converter;
pub use self::drive_lines::{DriveHealth, DriveLineParams};
pub use self::switches::SwitchParams;
pub use self::touch_probe::{TouchProbe, TouchProbeParams};

use self::brake::Brake;
use self::drive_lines::DriveLines;
use self::switches::Switches;
use crate::faults::{Fault, FaultyEncoder};
use crate::machine::{Machine, MachineParams};

/// Everything about a board on its machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BoardParams {
    /// When the drive is ready.
    pub drive_lines: DriveLineParams,
    /// Where the switches are.
    pub switches: SwitchParams,
    /// The brake and what it holds.
    pub brake: BrakeParams,
    /// The touch probe and what it touches.
    pub probe: TouchProbeParams,
}

/// What is wrong around the axis; set between two ticks. The default is nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Trouble {
    /// What the converter does.
    pub converter: Converter,
    /// What the drive tells of itself. A drive that is not ready brakes to a stop.
    pub drive: DriveHealth,
    /// The command's wires are exchanged.
    pub drive_reversed: bool,
    /// A pair of the encoder's wires is exchanged: it counts the other way.
    pub encoder_reversed: bool,
    /// The line receiver of the encoder sees no signal. It tells of it only; [`Board::break_encoder`] stops the
    /// counts.
    pub encoder_lost: bool,
    /// The same of the second encoder.
    pub master_lost: bool,
    /// The emergency-stop chain is open. It tells of it only; power stays on for the stop.
    pub emergency_stop: bool,
}

/// A machine and the board on it.
#[derive(Clone, Debug)]
pub struct Board {
    /// The machine.
    pub machine: Machine,
    /// What is wrong, to be changed between two ticks.
    pub trouble: Trouble,
    /// The touch probe, where there is one.
    pub probe: Option<TouchProbe>,
    drive_lines: DriveLines,
    switches: Switches,
    brake: Brake,
    faulty: Option<FaultyEncoder>,
    /// Count and timer at the last sampling instant.
    sampled: (u32, u32),
    home: Option<Latch>,
    readback: Command,
    missed_ticks: u16,
    /// Ticks that the axis is still to miss.
    to_miss: u16,
}

impl Board {
    /// A machine at rest with its drive off, with the errors that `seed` draws.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(
        params: &BoardParams,
        machine: &MachineParams,
        tick_hz: f64,
        seed: u64,
    ) -> Result<Self, RangeError> {
        let scale = AxisScale::new(machine.mount.counts_per_mm, tick_hz)?;
        let machine = Machine::new(machine, tick_hz, seed)?;
        let carriage = machine.truth().carriage.position;
        let capture = machine.capture();
        Ok(Self {
            sampled: (capture.count, capture.sampled_at),
            probe: TouchProbe::new(
                &params.probe,
                &machine,
                scale.counts_per_mm(),
                tick_hz,
                seed,
            )?,
            machine,
            trouble: Trouble::default(),
            drive_lines: DriveLines::new(&params.drive_lines, tick_hz)?,
            switches: Switches::new(&params.switches, scale.counts_per_mm(), carriage)?,
            brake: Brake::new(&params.brake, scale)?,
            faulty: None,
            home: None,
            readback: Command::ZERO,
            missed_ticks: 0,
            to_miss: 0,
        })
    }

    /// From the next tick on the encoder has `fault` in `ticks`, counted from that tick as 0, in place of any other.
    ///
    /// # Errors
    /// A figure of the fault out of range.
    pub fn break_encoder(&mut self, fault: Fault, ticks: Range<u32>) -> Result<(), RangeError> {
        if let Some(faulty) = &mut self.faulty {
            return faulty.inject(fault, ticks);
        }
        let capture = self.source();
        self.faulty = Some(FaultyEncoder::new(fault, ticks, &capture)?);
        Ok(())
    }

    /// The axis misses the next `ticks` ticks: the machine goes on under the last command.
    pub const fn miss(&mut self, ticks: u16) {
        self.to_miss = ticks;
    }

    /// True while the brake grips.
    #[must_use]
    pub const fn is_braked(&self) -> bool {
        self.brake.is_gripping()
    }

    /// Moves through one tick under what the axis put out before it, and through those that it misses.
    pub fn step(&mut self, outputs: &Outputs) {
        self.missed_ticks = core::mem::take(&mut self.to_miss);
        self.home = None;
        let before = self.sampled;
        let mut home = None;
        for tick in 0..=self.missed_ticks {
            self.move_on(outputs);
            let carriage = self.machine.truth().carriage.position;
            let share = self.switches.step(carriage);
            home = home.or(share.map(|share| f64::from(tick) + share));
            if let Some(probe) = &mut self.probe {
                probe.step(&self.machine);
            }
        }
        if let Some(faulty) = &mut self.faulty {
            faulty.apply(&self.machine.capture());
        }
        let mut probe = self.probe.take();
        let capture = self.source();
        if let Some(probe) = &mut probe {
            probe.sample(before, &capture);
        }
        let ticks = f64::from(self.missed_ticks) + 1.0;
        let home = home.map(|share| switches::latch(before, &capture, share / ticks));
        let sampled = (capture.count, capture.sampled_at);
        self.probe = probe;
        self.home = home;
        self.sampled = sampled;
    }

    /// The machine alone, for one tick.
    fn move_on(&mut self, outputs: &Outputs) {
        self.drive_lines.step(outputs.enabled);
        let is_ready = self.drive_lines.is_ready(self.trouble.drive);
        self.readback = self.trouble.converter.output(outputs.command);
        let command = if self.trouble.drive_reversed {
            -self.readback
        } else {
            self.readback
        };
        let powered = outputs.enabled && is_ready;
        let grip = self.brake.step(outputs.brake_released, powered);
        self.machine.step_gripped(command, powered, grip);
    }

    /// What the axis sees of this tick.
    #[must_use]
    pub fn inputs<'a>(&'a self, enable: bool, reference: Reference<'a>) -> Inputs<'a> {
        let mut capture = self.source();
        capture.home = self.home;
        if let Some(probe) = &self.probe {
            (capture.touching, capture.probe) = probe.input();
        }
        if self.trouble.encoder_reversed {
            capture = reversed(capture);
        }
        Inputs {
            capture,
            enable,
            lines: self.lines(),
            reference,
            readback: Some(self.readback),
            missed_ticks: self.missed_ticks,
        }
    }

    /// Levels of the discrete inputs.
    #[must_use]
    pub fn lines(&self) -> Lines {
        let Trouble {
            drive,
            encoder_lost,
            master_lost,
            emergency_stop,
            ..
        } = self.trouble;
        Lines {
            drive_ready: self.drive_lines.is_ready(drive),
            drive_fault: drive == DriveHealth::Faulty,
            encoder_lost,
            master_lost,
            limit_low: self.switches.low(),
            limit_high: self.switches.high(),
            home: self.switches.home(),
            emergency_stop,
        }
    }

    /// The capture before the wires.
    fn source(&self) -> Capture<'_> {
        match &self.faulty {
            Some(faulty) => faulty.capture(),
            None => self.machine.capture(),
        }
    }
}

/// The capture of an encoder with one differential pair exchanged: the levels of B are inverted, so that count k
/// becomes −1 − k, and with it the direction.
fn reversed(capture: Capture<'_>) -> Capture<'_> {
    let mirrored = |latch: Latch| Latch {
        count: !latch.count,
        ..latch
    };
    Capture {
        count: !capture.count,
        index: capture.index.map(mirrored),
        probe: capture.probe.map(mirrored),
        home: capture.home.map(mirrored),
        ..capture
    }
}
