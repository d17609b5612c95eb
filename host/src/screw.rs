//! The laser at the carriage: measures the screw, makes its table, shows what compensation leaves.
//!
//! The axis goes to each target from below and from above and comes to rest; a reading is where the carriage is less
//! where the axis says it is. What the servo leaves at rest is not the screw's and stands in a figure of its own.

use std::fmt;

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::compensation::{
    CompensationParams, ScrewError, ScrewPoint, ScrewTable, Stretch, TableError, TableRefused,
};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::hal::Encoder;
use leadscrew::params::{AxisParams, ParamError};
use leadscrew::setpoint::profile::{Limits, PlanError, Profile};
use leadscrew::setpoint::trajectory::QueueError;
use leadscrew::units::Position;
use leadscrew_hal_mock::machine::{Machine, MachineParams};

/// A screw to measure, on a machine with its axis.
#[derive(Clone, Copy, Debug)]
pub struct ScrewCase<'m> {
    /// The machine.
    pub machine: MachineParams,
    /// The axis on it; compensation is set by what is measured.
    pub axis: AxisParams,
    /// Map of its encoder.
    pub map: Option<EncoderMap<'m>>,
    /// What draws the machine's errors.
    pub seed: u64,
    /// Travel to measure, from 0 on, mm.
    pub travel_mm: f64,
    /// Points of the table.
    pub points: usize,
    /// Times that each point is measured from either side for the table; the mean counts, as in ISO 230-2.
    pub runs: usize,
    /// Standing still before a reading, s.
    pub settle_s: f64,
}

/// Readings at the targets of a survey, d.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// Place, and carriage less place having come from below and from above.
    pub readings: Vec<(f64, [f64; 2])>,
    /// Largest setpoint less encoder at rest.
    pub standing: f64,
}

/// What a survey came to, d.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScrewFigures {
    /// Largest carriage less place, either way.
    pub positioning: f64,
    /// Largest difference of a target reached from below and from above; half a discrete of either reading is where
    /// the shaft happens to stand within a count.
    pub reversal: f64,
    /// Mean of these differences over all targets: the mean reversal value of ISO 230-2.
    pub mean_reversal: f64,
    /// Largest setpoint less encoder at rest.
    pub standing: f64,
}

/// A screw without compensation, with backlash compensation alone, and with its table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeforeAndAfter {
    /// Points of the table.
    pub points: usize,
    /// Uncompensated.
    pub before: ScrewFigures,
    /// With the machine's backlash as a parameter, and no table.
    pub backlash: ScrewFigures,
    /// With the table, which holds both directions, at targets between its points.
    pub after: ScrewFigures,
}

/// Why a screw was not measured, or no table made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScrewFailure {
    /// A parameter is out of range.
    Param(ParamError),
    /// A move cannot be planned.
    Plan(PlanError),
    /// The axis did not take a move.
    Queue(QueueError),
    /// The readings make no table.
    Table(TableError),
    /// The axis did not take the table.
    Refused(TableRefused),
}

impl fmt::Display for ScrewFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Param(error) => error.fmt(f),
            Self::Plan(error) => error.fmt(f),
            Self::Queue(error) => error.fmt(f),
            Self::Table(error) => error.fmt(f),
            Self::Refused(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ScrewFailure {}

impl<E: Into<ParamError>> From<E> for ScrewFailure {
    fn from(error: E) -> Self {
        Self::Param(error.into())
    }
}

/// Ticks that a reading is the mean of.
const READING_TICKS: u32 = 50;
/// Share of the axis's limits that is used: play is told from the screw only if the axis does not overshoot by it.
const GENTLE: f64 = 0.1;
/// From where the first target is approached, d.
const RUN_UP_D: f64 = 2000.0;
/// Way over the index, d.
const APPROACH_D: f64 = 12_000.0;

impl<'m> ScrewCase<'m> {
    /// Measures the screw, makes its table and measures it again.
    ///
    /// # Errors
    /// [`ScrewFailure`].
    pub fn run(&self) -> Result<BeforeAndAfter, ScrewFailure> {
        let targets = self.targets(self.points, 0.0);
        let before = self.survey(CompensationParams::default(), None, &targets, self.runs)?;
        let points = before.points();
        let mut memory = vec![Stretch::default(); points.len()];
        let table = ScrewTable::build(&points, &mut memory).map_err(ScrewFailure::Table)?;
        // Off the points of the table, and at no multiple of their spacing.
        let others = self.targets(self.points * 5 / 8, 0.437);
        let with_backlash = CompensationParams {
            backlash_mm: self.machine.carriage.backlash_mm,
            ..CompensationParams::default()
        };
        let with_table = CompensationParams {
            screw_table: 1.0,
            ..CompensationParams::default()
        };
        Ok(BeforeAndAfter {
            points: points.len(),
            before: before.figures(),
            backlash: self.survey(with_backlash, None, &others, 1)?.figures(),
            after: self.survey(with_table, Some(table), &others, 1)?.figures(),
        })
    }

    /// `count` places over the travel, each `phase` of their spacing further on, d; the last one at its end.
    fn targets(&self, count: usize, phase: f64) -> Vec<f64> {
        let travel = self.travel_mm * self.axis.motion.counts_per_mm;
        let spacing = travel / (count.max(2) - 1) as f64;
        let place = |at: usize| ((at as f64 + phase) * spacing).min(travel);
        (0..count.max(2)).map(place).collect()
    }

    /// Readings at `targets`, which grow, with a compensation: the mean of so many runs there and back.
    ///
    /// # Errors
    /// [`ScrewFailure`].
    pub fn survey<'t>(
        &self,
        compensation: CompensationParams,
        table: Option<ScrewTable<'t>>,
        targets: &[f64],
        runs: usize,
    ) -> Result<Survey, ScrewFailure>
    where
        'm: 't,
    {
        let mut bench = Bench::new(self, compensation, table)?;
        let mut survey = Survey {
            readings: targets.iter().map(|place| (*place, [0.0; 2])).collect(),
            standing: 0.0,
        };
        let (Some(first), Some(last)) = (targets.first(), targets.last()) else {
            return Ok(survey);
        };
        let share = 1.0 / runs.max(1) as f64;
        for _ in 0..runs.max(1) {
            bench.go_to(first - RUN_UP_D)?;
            for (target, [forward, _]) in &mut survey.readings {
                *forward += share * bench.read_at(*target, &mut survey.standing)?;
            }
            bench.go_to(last + RUN_UP_D)?;
            for (target, [_, backward]) in survey.readings.iter_mut().rev() {
                *backward += share * bench.read_at(*target, &mut survey.standing)?;
            }
        }
        Ok(survey)
    }
}

impl Survey {
    /// The points of the table that undoes what was read.
    #[must_use]
    pub fn points(&self) -> Vec<ScrewPoint> {
        let point = |(place, errors): &(f64, [f64; 2])| ScrewPoint {
            position: Position::saturating_from_num(*place),
            error: errors.map(ScrewError::saturating_from_num),
        };
        self.readings.iter().map(point).collect()
    }

    /// What it came to.
    #[must_use]
    pub fn figures(&self) -> ScrewFigures {
        let largest =
            |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
        let readings = || self.readings.iter().map(|(_, errors)| errors);
        let reversals = || readings().map(|[forward, backward]| forward - backward);
        ScrewFigures {
            positioning: largest(&mut readings().flatten().copied()),
            reversal: largest(&mut reversals()),
            mean_reversal: reversals().sum::<f64>() / self.readings.len().max(1) as f64,
            standing: self.standing,
        }
    }
}

/// The machine under the laser.
struct Bench<'m> {
    machine: Machine,
    axis: Axis<'m>,
    outputs: Outputs,
    limits: Limits,
    settle_ticks: u32,
    /// Where the axis has the shaft's zero, d: there the laser is set to zero.
    zero: f64,
}

impl<'m> Bench<'m> {
    fn new(
        case: &ScrewCase<'m>,
        compensation: CompensationParams,
        table: Option<ScrewTable<'m>>,
    ) -> Result<Self, ScrewFailure> {
        // Before there is any compensation.
        let mut plain = Self::at_rest(case, CompensationParams::default(), None)?;
        let zero = plain.home()?;
        let mut bench = Self::at_rest(case, compensation, table)?;
        bench.home()?;
        bench.zero = zero;
        Ok(bench)
    }

    fn at_rest(
        case: &ScrewCase<'m>,
        compensation: CompensationParams,
        table: Option<ScrewTable<'m>>,
    ) -> Result<Self, ScrewFailure> {
        let params = AxisParams {
            compensation,
            ..case.axis
        };
        let mut axis = Axis::new(params.validate()?);
        axis.set_map(case.map);
        if table.is_some() {
            axis.set_screw_table(table).map_err(ScrewFailure::Refused)?;
        }
        axis.set_origin(Some(Position::ZERO));
        let limits = axis.config().limits;
        let limits = Limits::new(
            GENTLE * limits.velocity().to_num::<f64>(),
            GENTLE * limits.acceleration().to_num::<f64>(),
            GENTLE * limits.jerk().to_num::<f64>(),
        )?;
        let mut bench = Self {
            machine: Machine::new(&case.machine, params.tick_hz, case.seed)?,
            axis,
            outputs: Outputs::default(),
            limits,
            settle_ticks: (case.settle_s * params.tick_hz) as u32,
            zero: 0.0,
        };
        bench.stand(bench.settle_ticks);
        Ok(bench)
    }

    /// Over the index and back, so that the map is in use; on the way back the mean of where the axis has the shaft less
    /// where it is.
    fn home(&mut self) -> Result<f64, ScrewFailure> {
        self.go_to(APPROACH_D)?;
        let profile = self.move_to(0.0)?;
        let mut sum = 0.0;
        for _ in 0..profile {
            self.step();
            sum += self.outputs.reported.to_num::<f64>() - self.machine.truth().shaft.position;
        }
        self.stand(self.settle_ticks);
        Ok(sum / f64::from(profile))
    }

    fn step(&mut self) {
        self.machine
            .step(self.outputs.command, self.outputs.enabled);
        self.outputs = *self.axis.step(&Inputs::of(self.machine.capture(), true));
    }

    fn stand(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.step();
        }
    }

    /// Moves to a place, d from the origin, and waits for rest.
    fn go_to(&mut self, place: f64) -> Result<(), ScrewFailure> {
        let ticks = self.move_to(place)?;
        self.stand(ticks + self.settle_ticks);
        Ok(())
    }

    /// Starts a move to a place; its ticks.
    fn move_to(&mut self, place: f64) -> Result<u32, ScrewFailure> {
        let behind = Position::from_bits(i64::from(self.outputs.following_error.to_bits()));
        let commanded = self.outputs.reported + behind;
        let distance = Position::saturating_from_num(place) - commanded;
        let profile = Profile::plan(distance, &self.limits).map_err(ScrewFailure::Plan)?;
        let start = self.outputs.tick.wrapping_add(1);
        self.axis
            .queue(&profile, start)
            .map_err(ScrewFailure::Queue)?;
        Ok(profile.ticks())
    }

    /// Carriage less place at rest at `place`.
    fn read_at(&mut self, place: f64, standing: &mut f64) -> Result<f64, ScrewFailure> {
        self.go_to(place)?;
        let mut sum = 0.0;
        for _ in 0..READING_TICKS {
            self.step();
            let carriage = self.machine.truth().carriage.position;
            sum += carriage + self.zero - self.outputs.reported.to_num::<f64>();
            let behind: f64 = self.outputs.following_error.to_num();
            *standing = standing.max(behind.abs());
        }
        Ok(sum / f64::from(READING_TICKS))
    }
}
