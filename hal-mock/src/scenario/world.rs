//! The machine with what goes wrong at it.

use leadscrew::axis::{Inputs, Outputs};
use leadscrew::hal::{Capture, Encoder as _};
use leadscrew::units::RangeError;

use super::action::{EncoderTrouble, Interference, Trouble};
use crate::faults::{Bursts, Fault, FaultyEncoder};
use crate::machine::Machine;

/// The machine, its troubles, and the levels of its inputs.
#[derive(Clone, Debug)]
pub struct World {
    /// The machine.
    pub machine: Machine,
    /// From the first trouble at the encoder on.
    faulty: Option<FaultyEncoder>,
    timer_hz: f64,
    slips_until: Option<u32>,
    tick: u32,
}

impl World {
    /// A machine without trouble.
    #[must_use]
    pub const fn new(machine: Machine, timer_hz: f64) -> Self {
        Self {
            machine,
            faulty: None,
            timer_hz,
            slips_until: None,
            tick: 0,
        }
    }

    /// Lets trouble begin with the next step, for `ticks`.
    ///
    /// # Errors
    /// A figure of it out of range.
    pub fn begin(&mut self, trouble: &Trouble, ticks: u32) -> Result<(), RangeError> {
        let until = self.tick.saturating_add(ticks);
        match trouble {
            Trouble::Encoder(trouble) => {
                let fault = trouble.at_clock(self.timer_hz);
                match &mut self.faulty {
                    Some(faulty) => faulty.inject(fault, ticks)?,
                    None => {
                        let capture = self.machine.capture();
                        self.faulty = Some(FaultyEncoder::new(fault, 0..ticks, &capture)?);
                    }
                }
            }
            Trouble::CouplingSlip { share } => {
                self.machine.set_slip(*share);
                self.slips_until = Some(until);
            }
        }
        Ok(())
    }

    /// One tick: the machine moves as the axis wanted it in the last one.
    pub fn step(&mut self, outputs: &Outputs) {
        if self.slips_until == Some(self.tick) {
            self.machine.set_slip(0.0);
        }
        self.tick = self.tick.saturating_add(1);
        self.machine.step(outputs.command, outputs.enabled);
        if let Some(faulty) = &mut self.faulty {
            faulty.apply(&self.machine.capture());
        }
    }

    /// What the axis sees.
    #[must_use]
    pub fn inputs(&self, enable: bool) -> Inputs<'_> {
        Inputs::of(self.capture(), enable)
    }

    fn capture(&self) -> Capture<'_> {
        match &self.faulty {
            Some(faulty) => faulty.capture(),
            None => self.machine.capture(),
        }
    }
}

impl EncoderTrouble {
    /// The fault in clocks of the edge timer.
    fn at_clock(self, timer_hz: f64) -> Fault {
        let bursts = |found: Interference| Bursts {
            period_clocks: (timer_hz / found.burst_hz) as u32,
            pulses: found.pulses,
            width_clocks: (timer_hz * found.width_us * 1e-6) as u32,
        };
        match self {
            Self::FalseEdges(found) => Fault::FalseEdges(bursts(found)),
            Self::IllegalTransitions(found) => Fault::IllegalTransitions(bursts(found)),
            Self::LostEdges { every } => Fault::LostEdges { every },
            Self::DoubledEdges { every } => Fault::DoubledEdges { every },
            Self::DeadChannel(channel) => Fault::DeadChannel(channel),
            Self::DutyDrift { delay_us } => Fault::DutyDrift {
                delay_clocks: (timer_hz * delay_us * 1e-6) as u32,
            },
            Self::LineLoss => Fault::LineLoss,
            Self::Overrun { kept } => Fault::Overrun { kept },
        }
    }
}
