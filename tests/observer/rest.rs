//! Low speed and rest.

use leadscrew::estimator::observer::Config;
use leadscrew::units::Command;

use crate::evidence::Hand;

fn hand() -> Hand {
    Hand::new(Config::of_16k20f3().unwrap())
}

#[test]
fn silence_is_rest_after_the_set_time() {
    let mut hand = hand();
    for _ in 0..200 {
        hand.move_by(3.3);
    }
    let mut speeds = Vec::new();
    for _ in 0..110 {
        let heard = hand.stand();
        speeds.push(heard.estimate.velocity.to_num::<f64>().abs());
    }
    let estimate = hand.stand().estimate;
    assert_eq!(
        (estimate.velocity.to_bits(), estimate.acceleration.to_bits()),
        (0, 0)
    );
    // It stopped within a tick; what the silence allows falls with the time that it lasts.
    for (ticks, speed) in speeds.iter().enumerate().skip(20) {
        assert!(*speed <= 2.0 / ticks as f64, "{speed} after {ticks} ticks");
    }
    assert!((estimate.position.to_num::<f64>() - 660.5).abs() <= 1.5);
}

#[test]
fn an_edge_that_dithers_is_no_motion() {
    let mut hand = hand();
    let mut worst = 0.0_f64;
    for tick in 0..2000 {
        // To and fro across the boundary at 1, at times twice in a tick.
        let position = if tick % 3 == 0 { 1.02 } else { 0.98 };
        let estimate = hand.move_to(position, None).estimate;
        if tick > 200 {
            worst = worst.max(estimate.velocity.to_num::<f64>().abs());
            assert!(
                (estimate.position.to_num::<f64>() - 1.0).abs() < 0.3,
                "{estimate:?}"
            );
        }
    }
    assert!(
        worst < 0.06,
        "{worst} d/tick of a shaft that moves 0.04 d a tick"
    );
}

#[test]
fn motion_is_first_seen_on_the_second_edge() {
    let mut hand = hand();
    for _ in 0..200 {
        hand.stand();
    }
    let mut edges = 0;
    for _ in 0..60 {
        let heard = hand.move_by(0.1);
        edges += heard.delta;
        let velocity = heard.estimate.velocity.to_num::<f64>();
        if edges < 2 {
            assert_eq!(velocity, 0.0);
        }
    }
    let velocity = hand.move_by(0.1).estimate.velocity.to_num::<f64>();
    assert!((0.03..0.2).contains(&velocity), "{velocity}");
}

#[test]
fn a_reversal_makes_no_spike() {
    let mut hand = hand();
    let (mut position, mut worst) = (0.5, 0.0_f64);
    let mut velocity = 20.0;
    for tick in 0..1600 {
        let acceleration = if tick < 400 {
            0.0
        } else if tick < 800 {
            -0.1
        } else {
            0.0
        };
        velocity += acceleration;
        position += velocity;
        let estimate = hand.move_to(position, None).estimate;
        if tick > 200 {
            worst = worst.max((estimate.velocity.to_num::<f64>() - velocity).abs());
        }
    }
    assert!(worst < 0.5, "{worst}");
}

#[test]
fn a_command_ends_rest_before_the_first_edge() {
    let mut hand = hand();
    let at = |hand: &mut Hand, command: f64| {
        let command = Command::from_num(command);
        hand.move_to(0.5, Some(command))
            .estimate
            .velocity
            .to_num::<f64>()
    };
    for _ in 0..200 {
        assert_eq!(at(&mut hand, 0.005), 0.0);
    }
    // Slowly rising, as an integral against static friction: it stays at rest.
    for tick in 0..300 {
        assert_eq!(at(&mut hand, 0.005 + 1e-6 * f64::from(tick)), 0.0);
    }
    // A move begins: 2 d/tick more, two ticks later.
    let speeds: Vec<f64> = (0..6).map(|_| at(&mut hand, 0.018)).collect();
    assert_eq!(speeds[..2], [0.0, 0.0]);
    assert!(speeds[5] > 0.03, "{speeds:?}");
    // But nothing moves, and after the set silence it is rest again.
    for _ in 0..200 {
        at(&mut hand, 0.018);
    }
    assert_eq!(at(&mut hand, 0.018), 0.0);
}
