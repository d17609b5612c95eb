//! Calibration of a touch probe: what lies between the contact and the place that the axis latches.
//!
//! - [`delay`]: the trigger delay, from touches of one surface at two speeds or more;
//! - [`stylus`]: effective radius and pre-travel by direction, from touches of a ring or a sphere whose size is known;
//! - [`run_out`]: where the stylus stands beside the axis of the spindle, from touches at two angles of it, 180° apart.
//!
//! All of it is least squares, with the residuals, 1σ and flags of [`metrology`](crate::metrology).

pub mod delay;
pub mod run_out;
pub mod stylus;

use serde::Serialize;

use crate::metrology::adjustment::Adjusted;

/// Places and feeds, mm and mm/min: anything larger is a slip.
const RANGE: (f64, f64) = (-1e6, 1e6);

/// A value and its 1σ; none where nothing is redundant and nobody states one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Value {
    /// The value.
    pub value: f64,
    /// Its 1σ.
    pub sigma: Option<f64>,
}

impl Value {
    /// Unknown `index` of a fit, which began from `start`.
    fn of(adjusted: &Adjusted, index: usize, start: f64) -> Self {
        Self {
            value: start + adjusted.unknowns[index],
            sigma: adjusted.sigma(index),
        }
    }
}
