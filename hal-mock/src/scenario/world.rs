//! The machine and its board with what goes wrong there.

use leadscrew::axis::{Inputs, Outputs};
use leadscrew::hal::{self, Reference};
use leadscrew::units::{Command, RangeError};

use super::action::{Action, EncoderTrouble, Interference, Outer, Timed, Trouble};
use super::definition::Scenario;
use super::plant::Plant;
use crate::board::{self, Board, Converter, DriveHealth};
use crate::encoder::EncoderModel;
use crate::faults::{Bursts, Fault};
use crate::spindle::{Spindle, encoder_1024};

/// Troubles that may last at one time, of those that are no fault of the encoder.
const MOST_TROUBLES: usize = 8;

/// The machine, its board and their troubles.
#[derive(Clone, Debug)]
pub struct World {
    /// The board, with the machine.
    pub board: Board,
    /// The spindle, where the scenario has one.
    pub spindle: Option<Spindle>,
    tick_hz: f64,
    /// Steps of the outer control so far, and in a tick.
    steps: f64,
    steps_per_tick: f64,
    analog: Command,
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
    /// The world of `scenario`, without trouble and at rest.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(plant: &Plant, scenario: &Scenario<'_>) -> Result<Self, RangeError> {
        let Scenario { tick_hz, seed, .. } = *scenario;
        let model = encoder_1024(EncoderModel::real());
        let spindle = || Spindle::new(&plant.spindle, &model, tick_hz, seed);
        let is_turned = |timed: &Timed| {
            matches!(
                timed.action,
                Action::Set(Outer::SpindleSpeed { .. } | Outer::Cut(_))
            )
        };
        let has_spindle = plant.spindle.rpm != 0.0 || scenario.timeline.iter().any(is_turned);
        Ok(Self {
            board: Board::new(&plant.board, &plant.machine, tick_hz, seed)?,
            spindle: has_spindle.then(spindle).transpose()?,
            tick_hz,
            steps: 0.0,
            steps_per_tick: 0.0,
            analog: Command::ZERO,
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
            Trouble::ProbeGlitch => {
                if let Some(probe) = &mut self.board.probe {
                    probe.disturb();
                }
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

    /// Lets the outer control, or the spindle, do something from the next step on.
    pub fn set(&mut self, outer: &Outer) {
        match *outer {
            Outer::StepRate { steps_per_s } => self.steps_per_tick = steps_per_s / self.tick_hz,
            Outer::Analog { level } => self.analog = Command::saturating_from_num(level),
            Outer::SpindleSpeed { rpm } => {
                if let Some(spindle) = &mut self.spindle {
                    spindle.set_rpm(rpm);
                }
            }
            Outer::Cut(is_cutting) => {
                if let Some(spindle) = &mut self.spindle {
                    spindle.load(is_cutting);
                }
            }
        }
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
        self.steps += self.steps_per_tick;
        if let Some(spindle) = &mut self.spindle {
            spindle.step();
        }
    }

    /// What the axis sees.
    #[must_use]
    pub fn inputs(&self, enable: bool) -> Inputs<'_> {
        let reference = Reference {
            // The hardware's counter wraps.
            steps: libm::floor(self.steps) as i64 as u32,
            master: self.spindle.as_ref().map(hal::Encoder::capture),
            analog: self.analog,
        };
        let mut inputs = self.board.inputs(enable, reference);
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
                Trouble::MasterLost => {
                    wrong.master_lost = true;
                    if let Some(spindle) = &mut self.spindle {
                        spindle.cut_cable();
                    }
                }
                Trouble::IndexLost => self.index_lost = true,
                Trouble::StoreCorrupt => self.store_corrupt = true,
                Trouble::Encoder(_) | Trouble::MissedTicks { .. } | Trouble::ProbeGlitch => {}
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
