//! What a controller is fed with in these tests.

use leadscrew::controller::config::Gains;
use leadscrew::controller::{Config, Controller};
use leadscrew::estimator::{Estimate, Lags};
use leadscrew::output::ActiveLimits;
use leadscrew::setpoint::Setpoint;
use leadscrew::units::{Command, Position};

/// One LSB of a command.
pub const LSB: f64 = 1.0 / (1 << 30) as f64;
pub const NOT_LIMITED: ActiveLimits = ActiveLimits { high: false, low: false, slew: false };
pub const AT_HIGH: ActiveLimits = ActiveLimits { high: true, low: false, slew: false };
pub const AT_LOW: ActiveLimits = ActiveLimits { high: false, low: true, slew: false };

/// What one tick brings.
#[derive(Clone, Copy, Debug)]
pub struct Signals {
    pub setpoint: Setpoint,
    pub position: Position,
    pub estimate: Estimate,
}

/// An axis that stands `error` d behind its setpoint, all else zero.
pub fn standing(error: f64) -> Signals {
    let setpoint = Setpoint { position: Position::from_num(error), ..Setpoint::default() };
    Signals { setpoint, position: Position::ZERO, estimate: Estimate::default() }
}

pub fn lags(velocity: f64, acceleration: f64) -> Lags {
    use leadscrew::units::Lag;
    Lags { position: Lag::ZERO, velocity: Lag::from_num(velocity), acceleration: Lag::from_num(acceleration) }
}

/// A controller without deadband and bias.
pub fn controller(gains: Gains, transfer_ticks: f64) -> Controller {
    Controller::new(Config::new(&gains, 0.0, 0.0, transfer_ticks).unwrap())
}

/// The demand of a tick.
pub fn demand(controller: &mut Controller, signals: &Signals, active: ActiveLimits) -> Command {
    controller.step(&signals.setpoint, signals.position, &signals.estimate, active).command
}

/// The demand of a tick as a number, with no limit active.
pub fn demanded(controller: &mut Controller, signals: &Signals) -> f64 {
    demand(controller, signals, NOT_LIMITED).to_num()
}
