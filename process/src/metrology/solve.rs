//! The equations of a fit, solved over some of its touches.

use nalgebra::{DMatrix, DVector};

use super::adjustment::Model;
use super::error::MetrologyError;
use super::touch::Touch;

/// Equations with a greater condition number are refused: 100 mm known from touches 0.1 µm off a line.
const WORST_CONDITION: f64 = 1e6;
const MOST_STEPS: usize = 50;
/// A step below this, mm or rad, is the end.
const SMALL_STEP: f64 = 1e-12;
/// Rounding in ill-conditioned equations makes steps up to this, mm or rad.
const LARGEST_ROUNDING: f64 = 1e-7;
/// A touch whose residual keeps less than this part of its variance cannot be tested.
const LEAST_REDUNDANCY: f64 = 1e-6;

/// A solution over some of the touches.
pub(super) struct Solution {
    pub unknowns: Vec<f64>,
    /// Covariance if the weights are true.
    pub cofactor: DMatrix<f64>,
    /// Of all touches, mm, over the 1σ of the touch, and over that of the residual (0 where it has none).
    pub misfits: Vec<f64>,
    pub standardised: Vec<f64>,
    pub freedom: usize,
    /// Sum of the squares of misfits over 1σ.
    pub square_sum: f64,
}

/// Gauss and Newton: a linear model is done after the first step.
pub(super) fn solve<M: Model>(
    model: &M,
    touches: &[Touch],
    kept: &[bool],
) -> Result<Solution, MetrologyError> {
    let used: Vec<&Touch> = touches
        .iter()
        .zip(kept)
        .filter_map(|(touch, kept)| kept.then_some(touch))
        .collect();
    let mut unknowns = vec![0.0; model.unknowns()];
    let mut previous = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let step = Step::new(model, &used, &unknowns)?;
        for (unknown, change) in unknowns.iter_mut().zip(step.change.iter()) {
            *unknown += change;
        }
        let size = step.change.amax();
        if !unknowns.iter().all(|unknown| unknown.is_finite()) {
            break;
        }
        // Rounding is all that moves where steps are small and no longer shrink.
        if size < SMALL_STEP || (size < LARGEST_ROUNDING && size > previous / 2.0) {
            return Ok(step.solution(model, touches, kept, unknowns));
        }
        previous = size;
    }
    Err(MetrologyError::Diverges { what: M::WHAT })
}

fn weight(touch: &Touch) -> f64 {
    touch.sigma_mm.map_or(1.0, |sigma| 1.0 / sigma)
}

struct Step {
    change: DVector<f64>,
    cofactor: DMatrix<f64>,
    freedom: usize,
}

impl Step {
    fn new<M: Model>(
        model: &M,
        touches: &[&Touch],
        unknowns: &[f64],
    ) -> Result<Self, MetrologyError> {
        let count = unknowns.len();
        let mut equations = DMatrix::zeros(touches.len(), count);
        let mut misfits = DVector::zeros(touches.len());
        for (index, touch) in touches.iter().enumerate() {
            let weight = weight(touch);
            for (column, slope) in model.row(touch, unknowns).into_iter().enumerate() {
                equations[(index, column)] = slope * weight;
            }
            misfits[index] = model.misfit(touch, unknowns) * weight;
        }
        // Columns of length 1: an angle and a length then compare.
        let lengths: Vec<f64> = equations
            .column_iter()
            .map(|column| column.norm())
            .collect();
        for (mut column, length) in equations.column_iter_mut().zip(&lengths) {
            if *length > 0.0 {
                column /= *length;
            }
        }
        let parts = equations.svd(true, true);
        let (Some(left), Some(right)) = (&parts.u, &parts.v_t) else {
            return Err(MetrologyError::Diverges { what: M::WHAT });
        };
        let values = &parts.singular_values;
        let condition = values.max() / values.min();
        if condition.is_nan() || condition > WORST_CONDITION {
            let shares: Vec<f64> = right.row(values.imin()).iter().copied().collect();
            return Err(MetrologyError::Degenerate {
                what: M::WHAT,
                reason: model.why_degenerate(&shares),
                condition,
            });
        }
        let mut projected = left.transpose() * misfits;
        projected.component_div_assign(values);
        let mut change = right.transpose() * projected;
        let mut inverse = right.transpose();
        for (mut column, value) in inverse.column_iter_mut().zip(values.iter()) {
            column /= *value;
        }
        for (index, length) in lengths.iter().enumerate() {
            change[index] /= *length;
            inverse.row_mut(index).scale_mut(1.0 / *length);
        }
        Ok(Self {
            change,
            cofactor: &inverse * inverse.transpose(),
            freedom: touches.len() - count,
        })
    }

    fn solution<M: Model>(
        self,
        model: &M,
        touches: &[Touch],
        kept: &[bool],
        unknowns: Vec<f64>,
    ) -> Solution {
        let mut solution = Solution {
            misfits: Vec::with_capacity(touches.len()),
            standardised: Vec::with_capacity(touches.len()),
            freedom: self.freedom,
            square_sum: 0.0,
            cofactor: self.cofactor,
            unknowns,
        };
        for (touch, &kept) in touches.iter().zip(kept) {
            let weight = weight(touch);
            let misfit = model.misfit(touch, &solution.unknowns);
            let row = DVector::from_vec(model.row(touch, &solution.unknowns)) * weight;
            let leverage = (row.transpose() * &solution.cofactor * &row)[(0, 0)];
            // A touch left out is compared with what the others foretell.
            let variance = if kept { 1.0 - leverage } else { 1.0 + leverage };
            solution.misfits.push(misfit);
            solution.standardised.push(if variance > LEAST_REDUNDANCY {
                misfit * weight / variance.sqrt()
            } else {
                0.0
            });
            if kept {
                solution.square_sum += (misfit * weight).powi(2);
            }
        }
        solution
    }
}
