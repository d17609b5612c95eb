//! A machine as two chains of units, and the deviation of its tool from its workpiece.

use leadscrew_nc::coordinates::{Axis, Coordinates};
use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};

use super::error::DeviationError;
use super::law::Law;
use super::unit::{Drive, Unit};
use crate::setting_vector::SettingVector;

/// Who corrects the drives' own positioning errors, the diagonal of P4's matrix A.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveErrors {
    /// They are in the units' setting vectors: nothing else may correct them.
    Included,
    /// A screw map elsewhere, on the board or in the control, corrects them: the setting vectors are without.
    Elsewhere,
}

/// One of the two chains from the bed to the cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chain {
    /// Bed to workpiece.
    Workpiece,
    /// Bed to tool.
    Tool,
}

impl Chain {
    /// Its part in tool less workpiece.
    #[must_use]
    pub const fn sign(self) -> f64 {
        match self {
            Self::Workpiece => -1.0,
            Self::Tool => 1.0,
        }
    }

    /// `workpiece` or `tool`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Workpiece => "workpiece",
            Self::Tool => "tool",
        }
    }
}

/// A machine: chains of units from the bed outwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// What messages and tables call it.
    pub name: String,
    /// Where its deviations come from.
    pub origin: String,
    /// Units that carry the workpiece, from the bed.
    pub workpiece: Vec<Unit>,
    /// Units that carry the tool, from the bed.
    pub tool: Vec<Unit>,
    /// Place of the tool's tip in the frame of the last unit of the tool chain, mm.
    pub tool_mm: Vector3<f64>,
    /// Who corrects the drives' own errors.
    pub drive_errors: DriveErrors,
}

/// What a unit does at a place of the machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Part<'m> {
    /// The chain it is in.
    pub chain: Chain,
    /// The unit.
    pub unit: &'m Unit,
    /// Its setting vector ω in its own frame.
    pub omega: SettingVector,
    /// r: the tip of the tool seen from the unit's frame, in machine axes, mm.
    pub r: Vector3<f64>,
    /// Rotation of the units that carry it.
    pub base: Rotation3<f64>,
}

impl Part<'_> {
    /// Υ of this unit: its displacement of the tip, or of the workpiece there, in machine axes: W ω (P4 (5)).
    #[must_use]
    pub fn reduced(&self) -> SettingVector {
        self.omega.rotated(&self.base).reduced(&self.r)
    }

    /// How the tip moves against the workpiece for 1 mm or 1 rad of its coordinate, in machine axes.
    pub(super) fn motion(&self) -> SettingVector {
        let direction = self.base * self.unit.motion.direction().into_inner() * self.chain.sign();
        if self.unit.motion.is_rotary() {
            SettingVector {
                shift: Vector3::zeros(),
                turn: direction,
            }
            .reduced(&self.r)
        } else {
            SettingVector {
                shift: direction,
                turn: Vector3::zeros(),
            }
        }
    }
}

impl Machine {
    /// The units with their chains: workpiece first, each from the bed.
    pub fn units(&self) -> impl Iterator<Item = (Chain, &Unit)> {
        let workpiece = self.workpiece.iter().map(|unit| (Chain::Workpiece, unit));
        workpiece.chain(self.tool.iter().map(|unit| (Chain::Tool, unit)))
    }

    /// The axes that place units now with their ends, in the order of the axes.
    #[must_use]
    pub fn axes(&self) -> Vec<(Axis, (f64, f64))> {
        let placed = self.units().filter_map(|(_, unit)| match unit.drive {
            Drive::Placed { axis, range } => Some((axis, range)),
            Drive::Free { .. } => None,
        });
        let mut axes: Vec<_> = placed.collect();
        axes.sort_by_key(|(axis, _)| *axis);
        axes
    }

    /// The axes that its corrections use, in the order of the axes.
    #[must_use]
    pub fn corrected(&self) -> Vec<Axis> {
        let corrected = self.units().filter(|(_, unit)| unit.corrected);
        let mut axes: Vec<Axis> = corrected.filter_map(|(_, unit)| unit.axis()).collect();
        axes.sort();
        axes
    }

    /// What each unit does at a place: workpiece chain first, each from the bed.
    ///
    /// # Errors
    /// A coordinate beyond the ends of its unit.
    pub fn parts(&self, at: &Coordinates) -> Result<Vec<Part<'_>>, DeviationError> {
        let tip = self.nominal_frame(Chain::Tool, at)? * nalgebra::Point3::from(self.tool_mm);
        let mut parts = Vec::with_capacity(self.workpiece.len() + self.tool.len());
        for chain in [Chain::Workpiece, Chain::Tool] {
            let mut carrier = Isometry3::identity();
            for unit in self.chain(chain) {
                let coordinate = unit.coordinate(at)?;
                let frame = carrier * nominal(unit, coordinate);
                parts.push(Part {
                    chain,
                    unit,
                    omega: unit.setting(coordinate),
                    r: tip.coords - frame.translation.vector,
                    base: carrier.rotation.to_rotation_matrix(),
                });
                carrier = frame;
            }
        }
        Ok(parts)
    }

    /// Δ = Υ(tool) − Υ(workpiece): by how much the tool's tip is displaced and turned against the workpiece, in machine axes,
    /// for small deviations (P4 (5) and the difference after it).
    ///
    /// # Errors
    /// A coordinate beyond the ends of its unit.
    pub fn deviation(&self, at: &Coordinates) -> Result<SettingVector, DeviationError> {
        let parts = self.parts(at)?;
        let signed = |part: &Part<'_>| part.reduced() * part.chain.sign();
        Ok(parts
            .iter()
            .map(signed)
            .fold(SettingVector::ZERO, std::ops::Add::add))
    }

    /// The same machine with another tip of the tool, mm in the frame of the last unit of the tool chain.
    #[must_use]
    pub fn with_tool(mut self, tool_mm: Vector3<f64>) -> Self {
        self.tool_mm = tool_mm;
        self
    }

    /// The same machine with a freely turning unit placed by its axis instead; none where no such unit is.
    #[must_use]
    pub fn placing(mut self, wanted: Axis) -> Option<Self> {
        let mut units = self.workpiece.iter_mut().chain(&mut self.tool);
        let unit = units.find(|unit| unit.drive == Drive::Free { axis: Some(wanted) })?;
        unit.drive = Drive::Placed {
            axis: wanted,
            range: (-360.0, 360.0),
        };
        Some(self)
    }

    /// The same machine for a control that corrects the drives' own errors elsewhere: without them.
    #[must_use]
    pub fn without_drive_errors(mut self) -> Self {
        for unit in self.workpiece.iter_mut().chain(&mut self.tool) {
            if matches!(unit.drive, Drive::Placed { .. }) {
                unit.law = unit.law.without(unit.motion.drive_component());
            }
        }
        self.drive_errors = DriveErrors::Elsewhere;
        self
    }

    /// The same machine with all its deviations multiplied.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        for unit in self.workpiece.iter_mut().chain(&mut self.tool) {
            unit.law = unit.law.scaled(factor);
        }
        self
    }

    /// The same machine without deviations.
    #[must_use]
    pub fn perfect(mut self) -> Self {
        for unit in self.workpiece.iter_mut().chain(&mut self.tool) {
            unit.law = Law::NONE;
        }
        self
    }

    /// The units of a chain, from the bed.
    #[must_use]
    pub fn chain(&self, chain: Chain) -> &[Unit] {
        match chain {
            Chain::Workpiece => &self.workpiece,
            Chain::Tool => &self.tool,
        }
    }

    /// Nominal frame of the last unit of a chain in machine axes.
    pub(super) fn nominal_frame(
        &self,
        chain: Chain,
        at: &Coordinates,
    ) -> Result<Isometry3<f64>, DeviationError> {
        self.chain(chain)
            .iter()
            .try_fold(Isometry3::identity(), |carrier, unit| {
                Ok(carrier * nominal(unit, unit.coordinate(at)?))
            })
    }
}

/// A unit's frame in that of its carrier.
pub(super) fn nominal(unit: &Unit, coordinate: f64) -> Isometry3<f64> {
    Isometry3::from_parts(
        Translation3::from(unit.origin(coordinate)),
        UnitQuaternion::from_rotation_matrix(&unit.rotation(coordinate)),
    )
}
