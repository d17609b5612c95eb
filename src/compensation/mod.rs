//! Between setpoint and loop: what the screw does wrong, put right.

use crate::setpoint::Setpoint;

/// The compensation of an axis; so far none.
#[derive(Clone, Debug, Default)]
pub struct Compensation {}

impl Compensation {
    /// The setpoint of the encoder that brings the carriage to `commanded`.
    pub fn step(&mut self, commanded: &Setpoint) -> Setpoint {
        *commanded
    }
}
