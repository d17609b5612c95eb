//! The documented law in f64, with a bound on what the rounding of the fixed-point one may make of it.

use leadscrew::controller::config::Gains;
use leadscrew::estimator::Lags;
use leadscrew::setpoint::Setpoint;

use crate::signals::{LSB, Signals};

/// The law in f64, with a bound on what the fixed-point one may differ by.
pub struct Oracle {
    gains: Gains,
    lags: Lags,
    deadband: f64,
    bias: f64,
    transfer_ticks: f64,
    integral: f64,
    integral_bound: f64,
    previous: Option<f64>,
    transfer: f64,
    transfer_bound: f64,
}

impl Oracle {
    pub fn new(gains: Gains, lags: Lags, deadband: f64, bias: f64, transfer_ticks: f64) -> Self {
        let (integral, integral_bound, transfer, transfer_bound) = (0.0, 0.0, 0.0, 0.0);
        Self {
            gains,
            lags,
            deadband,
            bias,
            transfer_ticks,
            integral,
            integral_bound,
            previous: None,
            transfer,
            transfer_bound,
        }
    }

    /// Demand and bound.
    pub fn step(&mut self, signals: &Signals) -> (f64, f64) {
        let behind: f64 = (signals.setpoint.position - signals.position).to_num();
        let error = behind - behind.clamp(-self.deadband, self.deadband);
        let change = self.previous.map_or(0.0, |previous| error - previous);
        let first = self.previous.replace(error).is_none();
        self.integral = (self.integral + self.gains.integral * error).clamp(-1.0, 1.0);
        // Half a unit of the gain, 2⁻⁴⁰ per d and tick.
        self.integral_bound += 0.5_f64.powi(41) * error.abs();
        let (weighed, bound) = self.weighed(signals, error, change);
        let law = (self.bias + self.integral + weighed).clamp(-2.0, 2.0);
        // Rounding of the bias and of the sum, and the integral cut to an LSB.
        let bound = bound + self.integral_bound + 2.0 * LSB;
        if first {
            (self.transfer, self.transfer_bound) = (-law, bound);
        } else {
            // The factor is right to 2⁻³² and the product is rounded by an LSB.
            self.transfer_bound += self.transfer.abs() * 0.5_f64.powi(32) + LSB;
            self.transfer *= (-1.0 / self.transfer_ticks).exp();
        }
        (
            (law + self.transfer).clamp(-2.0, 2.0),
            bound + self.transfer_bound,
        )
    }

    /// The proportional terms, and what the rounding of the weights makes of them.
    fn weighed(&self, signals: &Signals, error: f64, change: f64) -> (f64, f64) {
        let Setpoint {
            velocity,
            acceleration,
            jerk,
            ..
        } = signals.setpoint;
        let (velocity, acceleration, jerk): (f64, f64, f64) =
            (velocity.to_num(), acceleration.to_num(), jerk.to_num());
        let (lag_v, lag_a): (f64, f64) =
            (self.lags.velocity.to_num(), self.lags.acceleration.to_num());
        let (seen_v, seen_a): (f64, f64) = (
            signals.estimate.velocity.to_num(),
            signals.estimate.acceleration.to_num(),
        );
        let gains = &self.gains;
        let lead = gains.feedforward_lead;
        let velocity_then = velocity - lag_v * acceleration + lag_v * lag_v * jerk / 2.0;
        let acceleration_then = acceleration - lag_a * jerk;
        let law = gains.position * error
            + gains.derivative * change
            + gains.velocity * (velocity_then - seen_v)
            + gains.acceleration * (acceleration_then - seen_a)
            + gains.velocity_feedforward
                * (velocity + lead * acceleration + lead * lead / 2.0 * jerk)
            + gains.acceleration_feedforward * (acceleration + lead * jerk)
            + gains.jerk_feedforward * jerk;

        // The same sorted by signal, in LSB per LSB: 30 bits of the command less those of the signal.
        let weights = [
            (gains.position, 14, error),
            (gains.derivative, 14, change),
            (gains.velocity, 10, seen_v),
            (gains.acceleration, 6, seen_a),
            (gains.velocity_feedforward + gains.velocity, 10, velocity),
            (
                gains.acceleration_feedforward
                    + lead * gains.velocity_feedforward
                    + gains.acceleration
                    - lag_v * gains.velocity,
                6,
                acceleration,
            ),
            (
                gains.jerk_feedforward
                    + lead * gains.acceleration_feedforward
                    + lead * lead / 2.0 * gains.velocity_feedforward
                    + lag_v * lag_v / 2.0 * gains.velocity
                    - lag_a * gains.acceleration,
                1,
                jerk,
            ),
        ];
        let total: f64 = weights
            .iter()
            .map(|(gain, bits, _)| gain.abs() * 2.0_f64.powi(*bits))
            .sum();
        // They share the finest power of two by which they add up to less than 2³¹ − 7, so one unit is at most
        // total/2³⁰; beyond 31 fractional bits they are not resolved. Each is off by half a unit.
        let unit = (2.0 * total / (f64::from(i32::MAX) - 7.0)).max(0.5_f64.powi(31));
        let signals: f64 = weights
            .iter()
            .map(|(_, bits, signal)| signal.abs() * 0.5_f64.powi(*bits))
            .sum();
        (law, 0.5 * unit * signals)
    }
}
