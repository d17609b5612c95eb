//! Backlash is taken up at a reversal, whole and smoothly, and not for less than a reversal.

use leadscrew::compensation::{CompensationParams, Heading};
use leadscrew::setpoint::Setpoint;
use leadscrew::units::Position;

use crate::motion::{at_origin, axis_limits, config, setpoints, settled, standing, with_backlash};

#[test]
fn a_reversal_takes_up_the_whole_backlash() {
    let config = config(&with_backlash(0.003));
    let mut compensation = at_origin(config, None);
    for (distance, wanted) in [(500.0, 1.5), (200.0, -1.5), (201.0, 1.5), (-7.0, -1.5)] {
        assert_eq!(settled(&mut compensation, distance), wanted);
    }
}

#[test]
fn less_than_a_reversal_takes_up_nothing() {
    let params = CompensationParams {
        reversal_mm: 0.002,
        ..with_backlash(0.003)
    };
    let mut compensation = at_origin(config(&params), None);
    settled(&mut compensation, 100.0);
    for place in [98.5, 99.5, 98.0, 100.0] {
        assert_eq!(settled(&mut compensation, place), 1.5);
    }
    assert_eq!(settled(&mut compensation, 97.9), -1.5);
    assert_eq!(compensation.heading(), Heading::Backward);
    // From here on the other way round.
    assert_eq!(settled(&mut compensation, 99.8), -1.5);
    assert_eq!(settled(&mut compensation, 100.0), 1.5);
}

#[test]
fn a_step_input_that_dithers_by_one_never_takes_up() {
    let params = CompensationParams {
        reversal_mm: 0.001,
        ..with_backlash(0.003)
    };
    let mut compensation = at_origin(config(&params), None);
    settled(&mut compensation, 0.0);
    for tick in 0..1000 {
        compensation.step(&standing(f64::from(tick & 1)));
        assert_eq!(compensation.amount(), 1.5);
    }
}

#[test]
fn a_take_up_is_smooth_and_over_within_60_ticks() {
    let config = config(&with_backlash(0.003));
    let mut compensation = at_origin(config, None);
    settled(&mut compensation, 0.0);
    let limits = config.setpoint_limits(&axis_limits()).unwrap();
    let moves = setpoints(&[-5000.0], &limits);
    let turned = moves
        .iter()
        .position(|setpoint| setpoint.position < Position::from_num(-0.5))
        .unwrap();
    let mut amounts = Vec::new();
    for commanded in &moves {
        compensation.step(commanded);
        amounts.push(compensation.amount().to_num::<f64>());
    }
    let behind = amounts[turned + 60] + 1.5;
    assert!(
        (0.0..0.05).contains(&behind),
        "{behind} d are left after 60 ticks"
    );
    let third = amounts
        .windows(4)
        .map(|at| (at[3] - 3.0 * at[2] + 3.0 * at[1] - at[0]).abs())
        .fold(0.0, f64::max);
    // The limiter steps by the rate: 0.375/9² d/tick³.
    assert!(third < 0.0055, "jerk {third} d/tick³");
}

#[test]
fn at_rest_nothing_moves_any_more() {
    let mut compensation = at_origin(config(&with_backlash(0.0031)), None);
    settled(&mut compensation, 10.0);
    let commanded = standing(10.0);
    let compensated = compensation.step(&commanded);
    assert_eq!(
        compensated,
        Setpoint {
            position: compensated.position,
            ..Setpoint::default()
        }
    );
    assert!((compensated.position.to_num::<f64>() - 11.55).abs() < 2e-5);
}
