//! How the drive's velocity follows what it aims at.

use super::DriveParams;

/// The second-order response, by the trapezoidal rule.
#[derive(Clone, Debug)]
pub struct Response {
    /// Share of the acceleration that stays after a tick.
    kept: f32,
    /// Acceleration for a gap of 1 d/tick.
    pull: f32,
}

impl Response {
    /// The response in ticks of `tick_hz`.
    pub fn new(params: &DriveParams, tick_hz: f64) -> Self {
        let omega = core::f64::consts::TAU / (params.natural_period_s * tick_hz);
        let (stiffness, damping) = (omega * omega, params.damping * omega);
        let quarter = 0.25 * stiffness;
        let all = 1.0 + damping + quarter;
        Self {
            kept: ((1.0 - damping - quarter) / all) as f32,
            pull: (stiffness / all) as f32,
        }
    }

    /// The acceleration at the end of a tick that begins with `acceleration` and `gap`.
    pub fn next(&self, acceleration: f32, gap: f32) -> f32 {
        self.kept * acceleration + self.pull * gap
    }
}
