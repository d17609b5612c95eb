//! The correction K = −Δ in the axes that a machine has.

use leadscrew_nc::coordinates::{Axis, AxisSet, Coordinates};
use nalgebra::{DMatrix, DVector, Vector3};

use super::error::DeviationError;
use super::machine::{Machine, Part};
use crate::setting_vector::SettingVector;

/// Least singular value of the directions of axes that count as independent.
const INDEPENDENT: f64 = 1e-6;

/// A correction and what it cannot reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// K, to be added to programmed coordinates: mm, degrees for rotary axes.
    pub k: Coordinates,
    /// Δ that is left with K in force: directions the machine has no axis for. Machine axes.
    pub left: SettingVector,
}

impl Machine {
    /// K = −Δ for the axes that are `corrected`: rotary axes turn away what deviation by angle they can reach, linear axes take
    /// away the deviation of place that is left then. For linear axes along x, y and z that is −Δ by component.
    ///
    /// # Errors
    /// A coordinate beyond the ends of its unit; axes to correct with that are not independent at this place.
    pub fn correction(&self, at: &Coordinates) -> Result<Correction, DeviationError> {
        let parts = self.parts(at)?;
        let mut left = parts
            .iter()
            .map(|part| part.reduced() * part.chain.sign())
            .fold(SettingVector::ZERO, std::ops::Add::add);
        let mut k = Coordinates::ZERO;
        for rotary in [true, false] {
            let moving: Vec<(Axis, SettingVector)> = parts
                .iter()
                .filter(|part| part.unit.corrected && part.unit.motion.is_rotary() == rotary)
                .filter_map(|part: &Part<'_>| Some((part.unit.axis()?, part.motion())))
                .collect();
            let by = |motion: &SettingVector| if rotary { motion.turn } else { motion.shift };
            for (&(axis, motion), amount) in moving.iter().zip(against(&moving, &left, by)?) {
                k[axis] = if rotary { amount.to_degrees() } else { amount };
                left += motion * amount;
            }
        }
        Ok(Correction { k, left })
    }
}

/// Amounts of the motions that leave the least of Δ, least squares.
fn against(
    moving: &[(Axis, SettingVector)],
    delta: &SettingVector,
    by: impl Fn(&SettingVector) -> Vector3<f64>,
) -> Result<Vec<f64>, DeviationError> {
    if moving.is_empty() {
        return Ok(Vec::new());
    }
    let columns: Vec<_> = moving.iter().map(|(_, motion)| by(motion)).collect();
    let directions = DMatrix::from_fn(3, columns.len(), |row, column| columns[column][row]);
    let svd = directions.svd(true, true);
    let independent = columns.len() <= 3 && svd.singular_values.iter().all(|&s| s > INDEPENDENT);
    let target = DVector::from_column_slice((-by(delta)).as_slice());
    let solved = svd.solve(&target, INDEPENDENT).ok();
    let dependent = || DeviationError::Dependent {
        axes: moving
            .iter()
            .map(|(axis, _)| *axis)
            .collect::<AxisSet>()
            .to_string(),
    };
    let amounts = solved.filter(|_| independent).ok_or_else(dependent)?;
    Ok(amounts.iter().copied().collect())
}
