//! The laser at the carriage: measures the screw, makes its table, shows what compensation leaves.
//!
//! The axis goes to each target from below and from above and comes to rest; a reading is where the carriage is less
//! where the axis says it is. What the servo leaves at rest is not the screw's and stands in a figure of its own.

mod bench;

use std::fmt;

use leadscrew::compensation::{
    CompensationParams, ScrewError, ScrewPoint, ScrewTable, Stretch, TableError, TableRefused,
};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::params::{AxisParams, ParamError};
use leadscrew::setpoint::profile::PlanError;
use leadscrew::setpoint::trajectory::QueueError;
use leadscrew::units::Position;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_process::axis_calibration::{Direction, Reading, Runs};

use self::bench::Bench;

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

/// From where the first target is approached, d.
const RUN_UP_D: f64 = 2000.0;

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
        let mut survey = Survey {
            readings: targets.iter().map(|place| (*place, [0.0; 2])).collect(),
            standing: 0.0,
        };
        let share = 1.0 / runs.max(1) as f64;
        let standing = self.visit(compensation, table, targets, runs, |_, at, way, error| {
            survey.readings[at].1[way] += share * error;
        })?;
        survey.standing = standing;
        Ok(survey)
    }

    /// The same reading by reading, as a laser writes them down for a calibration after ISO 230-2.
    ///
    /// # Errors
    /// [`ScrewFailure`].
    pub fn runs<'t>(
        &self,
        compensation: CompensationParams,
        table: Option<ScrewTable<'t>>,
        targets: &[f64],
        runs: usize,
    ) -> Result<Runs, ScrewFailure>
    where
        'm: 't,
    {
        let per_mm = self.axis.motion.counts_per_mm;
        let mut all = Runs::default();
        self.visit(compensation, table, targets, runs, |run, at, way, error| {
            all.readings.push(Reading {
                target_mm: targets[at] / per_mm,
                direction: Direction::BOTH[way],
                run: run as u32 + 1,
                deviation_um: 1000.0 * error / per_mm,
                temperature_c: None,
            });
        })?;
        Ok(all)
    }

    /// Goes to every target from below and, back again, from above, and tells `each` run, target, side and carriage less place,
    /// d. The largest setpoint less encoder at rest.
    fn visit<'t>(
        &self,
        compensation: CompensationParams,
        table: Option<ScrewTable<'t>>,
        targets: &[f64],
        runs: usize,
        mut each: impl FnMut(usize, usize, usize, f64),
    ) -> Result<f64, ScrewFailure>
    where
        'm: 't,
    {
        let mut bench = Bench::new(self, compensation, table)?;
        let mut standing = 0.0;
        let (Some(first), Some(last)) = (targets.first(), targets.last()) else {
            return Ok(standing);
        };
        for run in 0..runs.max(1) {
            bench.go_to(first - RUN_UP_D)?;
            for (at, target) in targets.iter().enumerate() {
                each(run, at, 0, bench.read_at(*target, &mut standing)?);
            }
            bench.go_to(last + RUN_UP_D)?;
            for (at, target) in targets.iter().enumerate().rev() {
                each(run, at, 1, bench.read_at(*target, &mut standing)?);
            }
        }
        Ok(standing)
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
