//! The parameters in d and ticks.

use super::design::Dynamics;
use super::params::ObserverParams;
use crate::units::{AxisScale, RangeError, checked};

/// Figures of a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerTick {
    pub full_velocity: f64,
    /// Coefficients of the jerk: −k₁ for a velocity, −k₂ for an acceleration.
    pub stiffness: f64,
    pub damping: f64,
    edge_noise: f64,
    time_noise: f64,
    model_noise: f64,
    disturbance_noise: f64,
    motion_noise: f64,
}

impl PerTick {
    pub fn new(params: &ObserverParams, scale: AxisScale) -> Result<Self, RangeError> {
        let rate = scale.tick_hz();
        let period_ticks = checked(
            "natural_period_ticks",
            params.natural_period_s * rate,
            8.0,
            2e4,
        )?;
        let omega = core::f64::consts::TAU / period_ticks;
        let [stiffness, damping] = response(omega, params.damping);
        let in_a_tick = 1.0 / libm::sqrt(rate);
        let acceleration = |noise: f64| scale.acceleration_from_m_s2(noise * in_a_tick);
        let velocity =
            scale.counts_from_mm(params.disturbance_noise_m_s2 * 1000.0 * in_a_tick) / rate;
        Ok(Self {
            full_velocity: checked(
                "full_command_d_per_tick",
                scale.velocity_from_feed(params.full_command_feed_mm_per_min)?,
                1e-3,
                2000.0,
            )?,
            stiffness,
            damping,
            edge_noise: params.edge_noise_d,
            time_noise: params.time_noise_s * rate,
            model_noise: acceleration(params.model_noise_m_s3),
            disturbance_noise: stiffness * velocity,
            motion_noise: acceleration(params.motion_noise_m_s3),
        })
    }

    pub fn drive(&self) -> Dynamics {
        Dynamics {
            jerk: [0.0, -self.stiffness, -self.damping, 1.0],
            jerk_noise: self.model_noise,
            disturbance_noise: self.disturbance_noise,
        }
    }

    pub fn kinematic(&self) -> Dynamics {
        Dynamics {
            jerk: [0.0; 4],
            jerk_noise: self.motion_noise,
            disturbance_noise: 0.0,
        }
    }

    /// Variance of the place that the edges of a tick give; `density` of them come in a tick.
    pub fn measurement(&self, density: f64) -> f64 {
        let edges = density.max(1.0);
        let in_time = density * self.time_noise;
        (self.edge_noise * self.edge_noise + in_time * in_time) / edges
    }
}

/// k₁ and k₂ of the response over a tick: the acceleration at its end is exact for a constant command.
///
/// With A = [0 1; −ω² −2ζω] of velocity and acceleration, the lower row of e^A is (−k₁, 1 − k₂), by its
/// series; ω ≤ 0.79 needs 24 terms at ζ = 10.
fn response(omega: f64, damping: f64) -> [f64; 2] {
    let (square, double) = (omega * omega, 2.0 * damping * omega);
    // Row (0, 1)·Aⁿ/n!, summed up.
    let (mut velocity, mut acceleration) = (0.0, 1.0);
    let mut sum = [0.0, 0.0];
    for term in 1..=64_u32 {
        let next_velocity = -acceleration * square;
        let next_acceleration = velocity - acceleration * double;
        velocity = next_velocity / f64::from(term);
        acceleration = next_acceleration / f64::from(term);
        sum = [sum[0] + velocity, sum[1] + acceleration];
    }
    sum.map(|share| -share)
}
