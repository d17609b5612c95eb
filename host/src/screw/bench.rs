//! The machine under the laser, tick by tick.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::compensation::{CompensationParams, ScrewTable};
use leadscrew::hal::Encoder;
use leadscrew::params::AxisParams;
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::units::Position;
use leadscrew_hal_mock::machine::Machine;

use super::{ScrewCase, ScrewFailure};

/// Ticks that a reading is the mean of.
const READING_TICKS: u32 = 50;
/// Share of the axis's limits that is used: play is told from the screw only if the axis does not overshoot by it.
const GENTLE: f64 = 0.1;
/// Way over the index, d.
const APPROACH_D: f64 = 12_000.0;

/// The machine under the laser.
pub(super) struct Bench<'m> {
    machine: Machine,
    axis: Axis<'m>,
    outputs: Outputs,
    limits: Limits,
    settle_ticks: u32,
    /// Where the axis has the shaft's zero, d: there the laser is set to zero.
    zero: f64,
}

impl<'m> Bench<'m> {
    pub(super) fn new(
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
    pub(super) fn go_to(&mut self, place: f64) -> Result<(), ScrewFailure> {
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
    pub(super) fn read_at(&mut self, place: f64, standing: &mut f64) -> Result<f64, ScrewFailure> {
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
