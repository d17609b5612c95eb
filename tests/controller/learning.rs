//! The feedforward's gains, learned from what the drive does.

use leadscrew::controller::Controller;
use leadscrew::controller::config::{Config, Extras, Gains};
use leadscrew::estimator::{Delay, Estimate, Lags};
use leadscrew::setpoint::Setpoint;
use leadscrew::units::{Acceleration, Command, Velocity};

use crate::signals::{NOT_LIMITED, lags};
use crate::turning::{half_a_tick_after, motion};

const WEIGHTS: [f64; 3] = [1.0 / 160.0, 14.3 / 160.0, 205.0 / 160.0];
/// Ticks of the command's delay.
const DELAY: usize = 2;
const BIAS: f64 = 0.005;

fn gains() -> Gains {
    let [
        velocity_feedforward,
        acceleration_feedforward,
        jerk_feedforward,
    ] = WEIGHTS;
    Gains {
        velocity_feedforward,
        acceleration_feedforward,
        jerk_feedforward,
        feedforward_lead: DELAY as f64 + 0.5,
        ..Gains::default()
    }
}

fn config_with(gains: &Gains, delay: Delay, learning_noise: f64) -> Config {
    let extras = Extras {
        learning_noise,
        ..Extras::default()
    };
    Config::with_extras(gains, delay, 0.0, BIAS, 1.0, &extras).unwrap()
}

fn learner() -> Controller {
    Controller::new(config_with(&gains(), Delay::from(&Lags::default()), 1e-3))
}

/// Command of a drive that asks for (1 + αᵢ) of each term, for the tick after a setpoint.
fn command(setpoint: &Setpoint, shares: [f64; 3]) -> f64 {
    let terms = half_a_tick_after(setpoint).into_iter().zip(WEIGHTS);
    let asked: f64 = terms
        .zip(shares)
        .map(|((signal, weight), share)| (1.0 + share) * signal * weight)
        .sum();
    asked + BIAS
}

/// A move of a drive with `shares`, seen with noise of up to ±`noise` d/tick² and its half in the velocity.
fn run(controller: &mut Controller, motion: &[Setpoint], shares: [f64; 3], noise: f64) {
    let mut draw = 7_u64;
    let mut random = move || {
        draw = draw.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        noise * ((draw >> 40) as f64 / f64::from(1 << 23) - 1.0)
    };
    for (at, now) in motion.iter().enumerate() {
        // Told in this tick: what acts, after the delay, on the tick that ends so much later.
        let acts = (at + DELAY).saturating_sub(1).min(motion.len() - 1);
        let whole = Command::from_num(command(&motion[acts], shares));
        let told = whole.saturating_sub(controller.withheld());
        let estimate = Estimate {
            velocity: now.velocity + Velocity::from_num(random() / 2.0),
            acceleration: now.acceleration + Acceleration::from_num(random()),
            ..Estimate::default()
        };
        controller.note(0, Some(told), &estimate);
        controller.step(now, now.position, &estimate, NOT_LIMITED);
    }
}

fn there_and_back(controller: &mut Controller, times: u32, shares: [f64; 3], noise: f64) {
    for _ in 0..times {
        for distance in [30_000.0, -30_000.0] {
            run(controller, &motion(distance), shares, noise);
        }
    }
}

fn assert_learned(controller: &Controller, shares: [f64; 3], within: [f64; 3]) {
    let learned = controller.learned();
    for ((learned, share), within) in learned.iter().zip(shares).zip(within) {
        assert!(
            (learned - share).abs() <= within,
            "{:?}",
            controller.learned()
        );
    }
}

/// A gain of −20 % and a period of +30 %; +20 % and −25 %.
const OFF: [[f64; 3]; 2] = [
    [1.0 / 0.8 - 1.0, 1.3 / 0.8 - 1.0, 1.69 / 0.8 - 1.0],
    [1.0 / 1.2 - 1.0, 0.75 / 1.2 - 1.0, 0.5625 / 1.2 - 1.0],
];

#[test]
fn gain_and_period_of_a_drive_are_found_within_a_move_there_and_back() {
    for shares in OFF {
        let mut controller = learner();
        there_and_back(&mut controller, 1, shares, 0.0);
        assert_learned(&controller, shares, [0.002, 0.02, 0.06]);
    }
}

#[test]
fn a_nominal_drive_leaves_the_feedforward_as_it_is() {
    let mut controller = learner();
    there_and_back(&mut controller, 2, [0.0; 3], 0.0);
    assert_learned(&controller, [0.0; 3], [0.001, 0.005, 0.01]);
}

#[test]
fn noise_of_the_estimates_does_not_draw_the_shares_towards_minus_one() {
    for shares in [[0.0; 3], OFF[0]] {
        let mut controller = learner();
        there_and_back(&mut controller, 6, shares, 0.05);
        assert_learned(&controller, shares, [0.01, 0.06, 0.12]);
    }
}

#[test]
fn what_is_learned_is_fed_forward_and_withheld_from_an_observer() {
    let mut controller = learner();
    let [shares, _] = OFF;
    there_and_back(&mut controller, 3, shares, 0.0);
    let motion = motion(30_000.0);
    // In the middle of the cruise and of the ramp.
    for at in [105, motion.len() / 2] {
        let now = &motion[at];
        let estimate = Estimate::default();
        let demand = controller.step(now, now.position, &estimate, NOT_LIMITED);
        let asked = command(&motion[at + DELAY], shares);
        let seen: f64 = demand.command.to_num();
        assert!((seen - asked).abs() < 2e-3, "{seen} for {asked}");
        let withheld: f64 = controller.withheld().to_num();
        let nominal = command(&motion[at + DELAY], [0.0; 3]);
        assert!((withheld - (asked - nominal)).abs() < 2e-3, "{withheld}");
    }
}

#[test]
fn it_is_kept_over_a_reset_and_forgotten_with_other_gains() {
    let mut controller = learner();
    there_and_back(&mut controller, 1, OFF[0], 0.0);
    let learned = controller.learned();
    controller.reset();
    assert_eq!(controller.learned(), learned);
    let same = config_with(&gains(), Delay::from(&Lags::default()), 1e-3);
    controller.reconfigure(same, Command::ZERO);
    assert_eq!(controller.learned(), learned);
    let other = Gains {
        velocity_feedforward: 0.005,
        ..gains()
    };
    let other = config_with(&other, Delay::from(&Lags::default()), 1e-3);
    controller.reconfigure(other, Command::ZERO);
    assert_eq!(controller.learned(), [0.0; 3]);
}

#[test]
fn a_blocked_axis_teaches_nothing() {
    let mut controller = learner();
    let standing = Estimate::default();
    for now in motion(30_000.0) {
        controller.note(0, Some(Command::from_num(0.9)), &standing);
        controller.step(&now, now.position, &standing, NOT_LIMITED);
    }
    assert_eq!(controller.learned(), [0.0; 3]);
}

#[test]
fn estimates_that_lag_are_refused() {
    let extras = Extras {
        learning_noise: 1e-3,
        ..Extras::default()
    };
    let delay = Delay::from(&lags(0.5, 1.0));
    let error = Config::with_extras(&gains(), delay, 0.0, 0.0, 1.0, &extras).unwrap_err();
    assert!(
        error.to_string().contains("lag of the estimates"),
        "{error}"
    );
}
