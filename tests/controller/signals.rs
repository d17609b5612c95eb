//! What a controller is fed with in these tests.

use leadscrew::controller::config::Gains;
use leadscrew::controller::{Config, Controller};
use leadscrew::estimator::{Estimate, Lags};
use leadscrew::output::ActiveLimits;
use leadscrew::setpoint::Setpoint;
use leadscrew::units::{Command, Lag, Position};

/// One LSB of a command.
pub const LSB: f64 = 1.0 / (1 << 30) as f64;
pub const NOT_LIMITED: ActiveLimits = ActiveLimits {
    high: false,
    low: false,
    slew: false,
};
pub const AT_HIGH: ActiveLimits = ActiveLimits {
    high: true,
    low: false,
    slew: false,
};
pub const AT_LOW: ActiveLimits = ActiveLimits {
    high: false,
    low: true,
    slew: false,
};

/// What one tick brings.
#[derive(Clone, Copy, Debug)]
pub struct Signals {
    pub setpoint: Setpoint,
    pub position: Position,
    pub estimate: Estimate,
}

/// An axis that stands `error` d behind its setpoint, all else zero.
pub fn standing(error: f64) -> Signals {
    let setpoint = Setpoint {
        position: Position::from_num(error),
        ..Setpoint::default()
    };
    Signals {
        setpoint,
        position: Position::ZERO,
        estimate: Estimate::default(),
    }
}

pub fn lags(velocity: f64, acceleration: f64) -> Lags {
    Lags {
        position: Lag::ZERO,
        velocity: Lag::from_num(velocity),
        acceleration: Lag::from_num(acceleration),
    }
}

/// A configuration for estimates without lag.
pub fn config(gains: &Gains, deadband_d: f64, bias: f64, transfer_ticks: f64) -> Config {
    Config::new(gains, &Lags::default(), deadband_d, bias, transfer_ticks).unwrap()
}

/// A controller without deadband and bias, for estimates without lag.
pub fn controller(gains: Gains, transfer_ticks: f64) -> Controller {
    Controller::new(config(&gains, 0.0, 0.0, transfer_ticks))
}

/// The demand of a tick.
pub fn demand(controller: &mut Controller, signals: &Signals, active: ActiveLimits) -> Command {
    controller
        .step(
            &signals.setpoint,
            signals.position,
            &signals.estimate,
            active,
        )
        .command
}

/// The demand of a tick as a number, with no limit active.
pub fn demanded(controller: &mut Controller, signals: &Signals) -> f64 {
    demand(controller, signals, NOT_LIMITED).to_num()
}
