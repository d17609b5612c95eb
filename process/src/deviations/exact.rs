//! The same machine with full rotations: what the small-angle sum is checked against, and what a simulated machine does.

use leadscrew_nc::coordinates::Coordinates;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion};

use super::error::DeviationError;
use super::machine::{Chain, Machine};
use crate::setting_vector::SettingVector;

impl Machine {
    /// Where the workpiece or the tool's last unit really is, in machine axes: place · ω · rotation, unit after unit.
    ///
    /// # Errors
    /// A coordinate beyond the ends of its unit.
    pub fn true_frame(
        &self,
        chain: Chain,
        at: &Coordinates,
    ) -> Result<Isometry3<f64>, DeviationError> {
        self.chain(chain)
            .iter()
            .try_fold(Isometry3::identity(), |carrier, unit| {
                let coordinate = unit.coordinate(at)?;
                Ok(carrier
                    * Translation3::from(unit.origin(coordinate))
                    * unit.setting(coordinate).to_isometry()
                    * UnitQuaternion::from_rotation_matrix(&unit.rotation(coordinate)))
            })
    }

    /// Where the tool's tip, and the axes of its last unit, really are in the frame of the workpiece.
    ///
    /// # Errors
    /// A coordinate beyond the ends of its unit.
    pub fn true_tip(&self, at: &Coordinates) -> Result<Isometry3<f64>, DeviationError> {
        let workpiece = self.true_frame(Chain::Workpiece, at)?;
        let tool = self.true_frame(Chain::Tool, at)?;
        Ok(workpiece.inverse() * tool * Translation3::from(self.tool_mm))
    }

    /// Where the tool's tip, and the axes of its last unit, should be in the frame of the workpiece.
    ///
    /// # Errors
    /// A coordinate beyond the ends of its unit.
    pub fn nominal_tip(&self, at: &Coordinates) -> Result<Isometry3<f64>, DeviationError> {
        let workpiece = self.nominal_frame(Chain::Workpiece, at)?;
        let tool = self.nominal_frame(Chain::Tool, at)?;
        Ok(workpiece.inverse() * tool * Translation3::from(self.tool_mm))
    }

    /// Δ by full rotations: the true tip less the nominal one as the workpiece sees them, in the axes of the machine.
    ///
    /// # Errors
    /// A coordinate beyond the ends of its unit.
    pub fn exact_deviation(&self, at: &Coordinates) -> Result<SettingVector, DeviationError> {
        let to_machine = self.nominal_frame(Chain::Workpiece, at)?.rotation;
        let (nominal, actual) = (self.nominal_tip(at)?, self.true_tip(at)?);
        Ok(SettingVector {
            shift: to_machine * (actual.translation.vector - nominal.translation.vector),
            turn: to_machine * (actual.rotation * nominal.rotation.inverse()).scaled_axis(),
        })
    }

    /// Most by which [`Machine::deviation`] can differ from [`Machine::exact_deviation`] in shift, mm:
    /// (½·Θ²·S + Θ·T)·e^Θ, where Θ is the sum of all units' turns (rad), S the longest way from a unit's frame to the tip and T
    /// the sum of all shifts (mm).
    ///
    /// # Errors
    /// A coordinate beyond the ends of its unit.
    pub fn small_angle_bound_mm(&self, at: &Coordinates) -> Result<f64, DeviationError> {
        let parts = self.parts(at)?;
        let theta: f64 = parts.iter().map(|part| part.omega.turn.norm()).sum();
        let shifts: f64 = parts.iter().map(|part| part.omega.shift.norm()).sum();
        let size = parts.iter().map(|part| part.r.norm()).fold(0.0, f64::max);
        Ok((0.5 * theta * theta * size + theta * shifts) * theta.exp())
    }

    /// Nominal place of the tool's tip in machine axes, mm.
    ///
    /// # Errors
    /// A coordinate beyond the ends of its unit.
    pub fn tip(&self, at: &Coordinates) -> Result<Point3<f64>, DeviationError> {
        Ok(self.nominal_frame(Chain::Tool, at)? * Point3::from(self.tool_mm))
    }
}
