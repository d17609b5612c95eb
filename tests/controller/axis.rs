//! The whole step: enabling, moves, and a change of configuration.

use leadscrew::axis::{Axis, Inputs};
use leadscrew::controller::Config;
use leadscrew::controller::config::Gains;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::paths::Choice;
use leadscrew::hal::Capture;
use leadscrew::output;
use leadscrew::params::{AxisConfig, AxisParams};
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::setpoint::trajectory::QueueError;
use leadscrew::supervisor::SupervisorParams;
use leadscrew::units::{Command, Position};

use crate::signals::config as controller_config;

/// A configuration with the estimator of that place in the list.
pub fn config(estimator: usize, controller: Config, limit: f64, slew: f64) -> AxisConfig {
    let estimator = EstimatorConfig::by_name(EstimatorConfig::NAMES[estimator]);
    let params = AxisParams {
        // Captures here are such as no machine gives.
        supervisor: SupervisorParams::widest(),
        ..AxisParams::new(estimator.unwrap().unwrap())
    };
    AxisConfig {
        controller,
        output: output::Config::new(limit, slew).unwrap(),
        limits: Limits::new(1000.0, 100.0, 3.0).unwrap(),
        ..params.validate().unwrap()
    }
}

fn quiet_axis() -> Axis<'static> {
    let gains = Gains {
        position: 0.01,
        integral: 1e-5,
        ..Gains::default()
    };
    Axis::new(config(
        0,
        controller_config(&gains, 0.0, 0.0, 50.0),
        1.0,
        2.0,
    ))
}

fn still(count: u32, enable: bool) -> Inputs<'static> {
    let capture = Capture {
        count,
        ..Capture::default()
    };
    Inputs::of(capture, enable)
}

#[test]
fn an_axis_is_enabled_where_it_stands_without_a_command() {
    let mut axis = quiet_axis();
    axis.step(&still(12_000, false));
    for _ in 0..100 {
        let outputs = axis.step(&still(12_345, true));
        assert_eq!(
            (outputs.following_error.to_bits(), outputs.command),
            (0, Command::ZERO)
        );
        assert_eq!(outputs.setpoint.position, Position::lit("12345.5"));
    }
}

#[test]
fn a_shaft_turned_by_hand_while_disabled_is_not_brought_back() {
    let mut axis = quiet_axis();
    (0..10).for_each(|_| _ = axis.step(&still(0, true)));
    (0..10).for_each(|_| _ = axis.step(&still(500, false)));
    assert_eq!(axis.step(&still(500, true)).command, Command::ZERO);
}

#[test]
fn a_move_needs_an_enabled_axis_and_is_dropped_with_it() {
    let mut axis = quiet_axis();
    let profile = Profile::plan(Position::from_num(100), &axis.config().limits).unwrap();
    axis.step(&still(0, false));
    assert_eq!(axis.queue(&profile, 5), Err(QueueError::Disabled));
    axis.step(&still(0, true));
    assert_eq!(
        axis.queue(&profile, 1),
        Err(QueueError::Late),
        "tick 1 has just been evaluated"
    );
    axis.queue(&profile, 2).unwrap();
    assert!(axis.step(&still(0, true)).moving);
    assert!(!axis.step(&still(0, false)).moving);
    for _ in 0..20 {
        let outputs = axis.step(&still(0, true));
        assert_eq!(
            (outputs.moving, outputs.setpoint.position),
            (false, Position::lit("0.5"))
        );
    }
}

#[test]
fn a_new_configuration_does_not_move_the_output_and_a_new_estimator_starts_afresh() {
    let mut axis = quiet_axis();
    axis.step(&still(0, true));
    let before = (0..50)
        .map(|_| *axis.step(&still(30, true)))
        .last()
        .unwrap();
    assert!(before.command != Command::ZERO);
    let gains = Gains {
        position: 0.05,
        ..Gains::default()
    };
    let exponential = 1;
    axis.reconfigure(&config(
        exponential,
        controller_config(&gains, 0.0, 0.1, 50.0),
        1.0,
        2.0,
    ))
    .unwrap();
    let after = *axis.step(&still(30, true));
    assert_eq!(after.command, before.command);
    assert_eq!(
        after.estimate.position,
        Position::lit("30.5"),
        "no jump from zero"
    );
    assert_eq!(
        axis.config().estimators.of(Choice::First).name(),
        "exponential"
    );
}
