//! The machine and its board with what goes wrong there.

use leadscrew::axis::{Inputs, Outputs};
use leadscrew::hal::Reference;
use leadscrew::units::{Command, RangeError};

use super::action::{EncoderTrouble, Interference, Trouble};
use super::plant::Plant;
use crate::board::{self, Board, Converter, DriveHealth};
use crate::faults::{Bursts, Fault};

/// Troubles that may last at one time, of those that are no fault of the encoder.
const MOST_TROUBLES: usize = 8;

/// The machine, its board and their troubles.
#[derive(Clone, Debug)]
pub struct World {
    /// The board, with the machine.
    pub board: Board,
    timer_hz: f64,
    /// Troubles that last, each with the first tick without it.
    lasting: [Option<(Trouble, u32)>; MOST_TROUBLES],
    /// The line of the index is broken.
    index_lost: bool,
    /// The parameter store is corrupt.
    store_corrupt: bool,
    tick: u32,
}

impl World {
    /// A world without trouble, at rest, with the errors that `seed` draws.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(plant: &Plant, tick_hz: f64, seed: u64) -> Result<Self, RangeError> {
        Ok(Self {
            board: Board::new(&plant.board, &plant.machine, tick_hz, seed)?,
            timer_hz: plant.machine.encoder.encoder.timer_hz,
            lasting: [None; MOST_TROUBLES],
            index_lost: false,
            store_corrupt: false,
            tick: 0,
        })
    }

    /// Lets trouble begin with the next step, for `ticks`.
    ///
    /// # Errors
    /// A figure of it out of range, or too many troubles at a time.
    pub fn begin(&mut self, trouble: &Trouble, ticks: u32) -> Result<(), RangeError> {
        match trouble {
            Trouble::Encoder(trouble) => {
                let fault = trouble.at_clock(self.timer_hz);
                return self.board.break_encoder(fault, 0..ticks);
            }
            Trouble::MissedTicks { ticks } => {
                self.board.miss(*ticks);
                return Ok(());
            }
            Trouble::SignalLoss => self.board.break_encoder(Fault::LineLoss, 0..ticks)?,
            _ => {}
        }
        let until = self.tick.saturating_add(ticks);
        let Some(free) = self.lasting.iter_mut().find(|place| place.is_none()) else {
            return Err(RangeError {
                name: "troubles at one time",
                value: MOST_TROUBLES as f64 + 1.0,
                min: 0.0,
                max: MOST_TROUBLES as f64,
            });
        };
        *free = Some((*trouble, until));
        self.settle();
        Ok(())
    }

    /// One tick: the machine moves as the axis wanted it in the last one.
    pub fn step(&mut self, outputs: &Outputs) {
        let is_over = |place: &Option<(Trouble, u32)>| matches!(place, Some((_, until)) if *until <= self.tick);
        if self.lasting.iter().any(is_over) {
            let now = self.tick;
            for place in &mut self.lasting {
                *place = place.filter(|(_, until)| *until > now);
            }
            self.settle();
        }
        self.tick = self.tick.saturating_add(1);
        self.board.step(outputs);
    }

    /// What the axis sees.
    #[must_use]
    pub fn inputs(&self, enable: bool) -> Inputs<'_> {
        let mut inputs = self.board.inputs(enable, Reference::default());
        if self.index_lost {
            inputs.capture.index = None;
        }
        inputs
    }

    /// The parameter store is corrupt.
    #[must_use]
    pub const fn store_corrupt(&self) -> bool {
        self.store_corrupt
    }

    /// Makes of the board what the troubles that last make of it.
    fn settle(&mut self) {
        let mut wrong = board::Trouble::default();
        let mut slip = 0.0;
        (self.index_lost, self.store_corrupt) = (false, false);
        for (trouble, _) in self.lasting.iter().flatten() {
            match *trouble {
                Trouble::CouplingSlip { share } => slip = share,
                Trouble::SignalLoss => wrong.encoder_lost = true,
                Trouble::EncoderReversed => wrong.encoder_reversed = true,
                Trouble::DriveReversed => wrong.drive_reversed = true,
                Trouble::DriveFault => wrong.drive = DriveHealth::Faulty,
                Trouble::DriveNotReady => wrong.drive = DriveHealth::NeverReady,
                Trouble::ConverterStuck { output } => {
                    wrong.converter = Converter::Stuck(Command::saturating_from_num(output));
                }
                Trouble::ConverterOffset { offset } => {
                    wrong.converter = Converter::OffBy(Command::saturating_from_num(offset));
                }
                Trouble::EmergencyStop => wrong.emergency_stop = true,
                Trouble::MasterLost => wrong.master_lost = true,
                Trouble::IndexLost => self.index_lost = true,
                Trouble::StoreCorrupt => self.store_corrupt = true,
                Trouble::Encoder(_) | Trouble::MissedTicks { .. } => {}
            }
        }
        self.board.trouble = wrong;
        self.board.machine.set_slip(slip);
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
