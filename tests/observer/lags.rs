//! Stated lags are those of the response: at constant velocity, acceleration, jerk.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::{Config, Model};
use leadscrew::hal::Encoder as _;
use leadscrew::uncertainty::EdgeErrors;
use leadscrew::units::{AxisScale, Command};
use leadscrew_hal_mock::arc::State;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::Machine;
use leadscrew_hal_mock::scene::Motion;
use leadscrew_host::accuracy::Trial;

use crate::evidence::Listener;
use crate::runs::{bare, mapped, tuned_on};

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Truth less estimate of x, v, a in each tick of a drive told to move so that after its transient velocity,
/// acceleration and jerk are as `motion` says at each tick.
fn errors(ticks: std::ops::Range<u32>, motion: impl Fn(f64) -> State, jerk: f64) -> Vec<[f64; 3]> {
    let mut machine = bare();
    machine.drive.resolution = 0.0;
    let params = tuned_on(&machine);
    let scale = AxisScale::new(1000.0, 1000.0).unwrap();
    let mut listener = Listener::new(Config::new(&params, scale).unwrap());
    let mut shaft = Machine::new(&mapped(machine), 1000.0, 1).unwrap();
    let omega = core::f64::consts::TAU / 90.0;
    let mut errors = Vec::new();
    for tick in 0..ticks.end {
        let State {
            velocity,
            acceleration,
            ..
        } = motion(f64::from(tick));
        let wanted = velocity + acceleration / omega + jerk / (omega * omega);
        let command = Command::from_num(wanted / 160.0);
        shaft.step(command, true);
        let estimate = listener.hear(&shaft.capture(), Some(command)).estimate;
        assert_eq!(listener.observer.model(), Model::Drive);
        let truth = shaft.truth().shaft;
        if ticks.contains(&tick) {
            errors.push([
                truth.position - estimate.position.to_num::<f64>(),
                truth.velocity - estimate.velocity.to_num::<f64>(),
                truth.acceleration - estimate.acceleration.to_num::<f64>(),
            ]);
        }
    }
    errors
}

#[test]
fn the_drive_model_has_no_lag() {
    let steady = errors(
        500..1000,
        |_| State {
            velocity: 50.3,
            ..State::default()
        },
        0.0,
    );
    let lag_x = mean(&steady.iter().map(|[x, ..]| x / 50.3).collect::<Vec<_>>());
    let ramp = |tick: f64| State {
        velocity: 0.2 * tick,
        acceleration: 0.2,
        ..State::default()
    };
    let ramp = errors(350..700, ramp, 0.0);
    let lag_v = mean(&ramp.iter().map(|[_, v, _]| v / 0.2).collect::<Vec<_>>());
    let lag_a_of_ramp = mean(&ramp.iter().map(|[.., a]| a / 0.2).collect::<Vec<_>>());
    const JERK: f64 = 0.0015;
    let jerked = |tick: f64| State {
        velocity: JERK * tick * tick / 2.0,
        acceleration: JERK * tick,
        ..State::default()
    };
    let jerked = errors(250..440, jerked, JERK);
    let lag_a = mean(&jerked.iter().map(|[.., a]| a / JERK).collect::<Vec<_>>());
    for (name, lag) in [("x", lag_x), ("v", lag_v), ("a on a ramp", lag_a_of_ramp)] {
        assert!(lag.abs() < 0.02, "lag_{name} {lag}");
    }
    assert!(lag_a.abs() < 0.5, "lag_a {lag_a}");
}

#[test]
fn the_kinematic_model_states_its_lags() {
    let observer = EstimatorConfig::by_name("observer").unwrap().unwrap();
    let observe = |motion, ticks| {
        let trial = Trial {
            motion,
            encoder: EncoderModel::ideal(),
            errors: EdgeErrors::default(),
            tick_hz: 1000.0,
            ticks,
            seed: 1,
        };
        trial.observe(observer).unwrap()
    };
    let steady = observe(Motion::Steady { velocity: 50.3 }, 1000);
    let ramp = observe(
        Motion::Ramp {
            velocity: 10.0,
            acceleration: 0.9,
        },
        1000,
    );
    assert!(
        steady.response_lag_x().abs() < 0.01,
        "{}",
        steady.response_lag_x()
    );
    assert!(
        ramp.response_lag_v().abs() < 0.01,
        "{}",
        ramp.response_lag_v()
    );
    const JERK: f64 = 0.02;
    let jerked = observe(Motion::Jerk { jerk: JERK }, 200);
    let stated = jerked.mean_now(|estimate, _| estimate.lags.acceleration.to_num::<f64>());
    let measured = jerked.response_lag_a(JERK);
    assert!((0.5..10.0).contains(&stated), "{stated}");
    assert!(
        (measured - stated).abs() < 0.5,
        "stated {stated}, measured {measured}"
    );
}
