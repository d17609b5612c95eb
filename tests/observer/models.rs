//! Which model runs, and how it changes.

use leadscrew::estimator::observer::{Config, Model, ObserverParams};
use leadscrew::estimator::{Estimator, EstimatorConfig};
use leadscrew::units::{AxisScale, Command};

use crate::evidence::Hand;
use crate::runs::{Loop, bare, rms};

/// Of the bare machine.
fn params() -> ObserverParams {
    ObserverParams {
        delay_s: 0.0,
        offset: 0.0,
        ..ObserverParams::default()
    }
}

fn config(params: &ObserverParams) -> Config {
    Config::new(params, AxisScale::new(1000.0, 1000.0).unwrap()).unwrap()
}

fn in_loop<'a>(
    axis: &'a leadscrew::axis::Axis<'_>,
) -> &'a leadscrew::estimator::observer::Estimator {
    match axis.estimator() {
        Estimator::Observer(observer) => observer,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_drive_model_runs_in_the_loop_from_the_start_and_stays() {
    let run = Loop::nominal(bare());
    let (_, axis) = run.run_with(EstimatorConfig::Observer(config(&run.observer)));
    let observer = in_loop(&axis);
    assert_eq!(
        (observer.model(), observer.fallbacks(), observer.restarts()),
        (Model::Drive, 0, 0)
    );
}

#[test]
fn without_a_command_the_kinematic_model_runs() {
    let mut hand = Hand::new(config(&params()));
    for _ in 0..300 {
        hand.move_by(20.25);
        assert_eq!(hand.listener.observer.model(), Model::Kinematic);
    }
    let estimate = hand.move_by(20.25).estimate;
    assert!(estimate.lags.acceleration.to_num::<f64>() > 0.5);
    assert!((estimate.velocity.to_num::<f64>() - 20.25).abs() < 0.01);
}

#[test]
fn a_delay_is_waited_for_and_a_command_that_ends_is_left_at_once() {
    let mut hand = Hand::new(config(&ObserverParams {
        delay_s: 0.005,
        ..params()
    }));
    let mut step = |command| {
        hand.move_to(0.5, command);
        hand.listener.observer.model()
    };
    for _ in 0..5 {
        assert_eq!(step(Some(Command::ZERO)), Model::Kinematic);
    }
    assert_eq!(step(Some(Command::ZERO)), Model::Drive);
    assert_eq!(step(None), Model::Kinematic);
}

#[test]
fn a_model_that_the_motion_does_not_follow_is_given_up_and_the_loop_goes_on() {
    // A drive of a tenth of the gain and a ninth of the period it has.
    let mut run = Loop::nominal(bare());
    run.observer.natural_period_s = 0.01;
    run.observer.full_command_feed_mm_per_min = 96_000.0;
    let (ticks, axis) = run.run_with(EstimatorConfig::Observer(config(&run.observer)));
    let observer = in_loop(&axis);
    assert!(
        (1..8).contains(&observer.fallbacks()),
        "{}",
        observer.fallbacks()
    );
    // Between fallbacks, which a return to the wrong model brings, the kinematic model is right.
    let mut errors: Vec<f64> = ticks
        .iter()
        .map(|tick| tick.acceleration_error().abs())
        .collect();
    errors.sort_by(f64::total_cmp);
    let median = errors[errors.len() / 2];
    assert!(median < 0.02, "{median}");
}

#[test]
fn the_drive_model_is_taken_back_when_it_predicts_well() {
    // A drive that does not turn for a while: command without motion, motion without command.
    let scale = AxisScale::new(1000.0, 1000.0).unwrap();
    let strict = ObserverParams {
        fallback_sigmas: 10.0,
        ..params()
    };
    let mut hand = Hand::new(Config::new(&strict, scale).unwrap());
    let mut position = 0.5;
    let (mut velocity, mut acceleration) = (0.0, 0.0);
    let omega = core::f64::consts::TAU / 90.0;
    let mut changes = Vec::new();
    let mut errors = Vec::new();
    for tick in 0..3000_u32 {
        // Told to swing to and fro, later slowly; from tick 600 to 1 000 the drive has its sign reversed.
        let (swing, step) = if tick < 1000 {
            (0.1, 0.1)
        } else {
            (0.05, 0.02)
        };
        let told = 0.3 + swing * (f64::from(tick) * step).sin();
        let command = Command::from_num(told);
        let sign = if (600..1000).contains(&tick) {
            -1.0
        } else {
            1.0
        };
        let jerk = omega * omega * (sign * 160.0 * told - velocity) - omega * acceleration;
        position += velocity + acceleration / 2.0 + jerk / 6.0;
        velocity += acceleration + jerk / 2.0;
        acceleration += jerk;
        let heard = hand.move_to(position, Some(command));
        let model = hand.listener.observer.model();
        if changes.last().is_none_or(|(_, last)| *last != model) {
            changes.push((tick, model));
        }
        if tick >= 2000 {
            errors.push(heard.estimate.acceleration.to_num::<f64>() - acceleration);
        }
    }
    let models: Vec<Model> = changes.iter().map(|(_, model)| *model).collect();
    assert_eq!(models.first(), Some(&Model::Drive), "{changes:?}");
    assert!(models.contains(&Model::Kinematic), "{changes:?}");
    let (last, model) = *changes.last().unwrap();
    assert_eq!(model, Model::Drive, "{changes:?}");
    assert!((1000..2000).contains(&last), "{changes:?}");
    assert!(hand.listener.observer.fallbacks() >= 1);
    assert!(rms(errors.into_iter()) < 0.02);
}

#[test]
fn a_jump_of_the_count_begins_anew() {
    let mut hand = Hand::new(config(&params()));
    for _ in 0..100 {
        hand.move_by(50.0);
    }
    let mut position = 0.5 + 5000.0 + 300.0;
    hand.move_to(position, None);
    for _ in 0..100 {
        position += 50.0;
        hand.move_to(position, None);
    }
    let estimate = hand.stand().estimate;
    assert!((1..=4).contains(&hand.listener.observer.restarts()));
    assert!((estimate.position.to_num::<f64>() - position).abs() < 60.0);
}
