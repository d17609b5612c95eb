//! One parameter of a setting vector as a function of the coordinate: constant, slope and waves.

use std::f64::consts::TAU;

use crate::setting_vector::Component;

/// A sine over the coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// mm or rad.
    pub amplitude: f64,
    /// mm, or degrees for a rotary unit: there a whole part of 360.
    pub period: f64,
    /// Degrees of the wave at the coordinate 0.
    pub phase_deg: f64,
}

/// One parameter as a function of the coordinate: constant, slope and waves.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// The parameter.
    pub component: Component,
    /// At the coordinate 0, waves apart; mm or rad.
    pub constant: f64,
    /// mm or rad for each mm of the coordinate; 0 for a rotary unit.
    pub slope: f64,
    /// Waves.
    pub waves: Vec<Wave>,
}

impl Function {
    pub(super) fn at(&self, place: f64) -> f64 {
        let wave = |wave: &Wave| {
            wave.amplitude * (TAU * place / wave.period + wave.phase_deg.to_radians()).sin()
        };
        self.constant + self.slope * place + self.waves.iter().map(wave).sum::<f64>()
    }
}
