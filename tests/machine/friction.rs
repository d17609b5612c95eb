//! Friction of the drive: stiction, Stribeck, coming to rest.

use leadscrew_hal_mock::arc::{Arc, State};
use leadscrew_hal_mock::drive::DriveParams;

use crate::drive::{bare, command, drive, run};

/// Friction of the reference machine alone: 1.5 d/tick kinetic, 3 static, Stribeck velocity 1.
fn rough() -> DriveParams {
    DriveParams {
        friction_mm_per_min: 90.0,
        ..bare()
    }
}

/// Speed at which demand less friction is the speed.
fn equilibrium(demand: f64) -> f64 {
    let (mut low, mut high) = (0.0, demand);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if demand - 1.5 - 1.5 / (1.0 + middle * middle) > middle {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[test]
fn static_friction_holds_below_its_level_and_lets_go_above() {
    // 3 d/tick of 160 are 0.01875 of full command.
    for demand in [0.0187, -0.0187] {
        let arcs = run(&mut drive(&rough(), 1000.0), demand, 1000);
        assert!(arcs.iter().all(|arc| *arc == Arc::default()), "{demand}");
    }
    for demand in [0.0188, 0.03, 0.5] {
        let velocity = run(&mut drive(&rough(), 1000.0), demand, 3000)
            .last()
            .unwrap()
            .end()
            .velocity;
        let expected = equilibrium(demand * 160.0);
        assert!(
            (velocity - expected).abs() < 1e-6,
            "{demand}: {velocity} instead of {expected}"
        );
        let back = run(&mut drive(&rough(), 1000.0), -demand, 3000)
            .last()
            .unwrap()
            .end()
            .velocity;
        assert_eq!(back, -velocity);
    }
}

#[test]
fn a_moving_shaft_goes_on_below_the_static_level_until_it_sticks() {
    // 2 d/tick are below the static 3 but above the kinetic 1.5: the shaft comes to rest from speed, and stays.
    let mut drive = drive(&rough(), 1000.0);
    run(&mut drive, 0.5, 1000);
    let slowing = run(&mut drive, 2.0 / 160.0, 2000);
    let stop = slowing
        .iter()
        .position(|arc| arc.end().velocity == 0.0)
        .expect("it sticks");
    assert!(
        slowing[..stop].iter().all(|arc| arc.end().velocity > 0.0),
        "it does not swing back through rest"
    );
    assert!(
        slowing[stop + 1..]
            .iter()
            .all(|arc| arc.start.velocity == 0.0 && arc.end().velocity == 0.0)
    );
    // The catch itself stays within the acceleration limit.
    assert!(
        slowing
            .iter()
            .all(|arc| arc.end().acceleration.abs() <= 2.1 + 1e-12)
    );
}

#[test]
fn a_shaft_that_friction_caught_starts_again_as_one_that_never_moved() {
    let shaft_at = |position| State {
        position,
        ..State::default()
    };
    for slow in [0.0, 2.0 / 160.0, -2.0 / 160.0] {
        let mut caught = drive(&rough(), 1000.0);
        run(&mut caught, 0.5, 1000);
        // The last tick run is the one within which the shaft comes to rest.
        let stop = (0..2000)
            .map(|_| caught.step(command(slow), true))
            .find(|arc| arc.end().velocity == 0.0)
            .expect("it sticks");
        assert!(stop.start.velocity > 0.0, "{stop:?}");
        assert_eq!(caught.shaft(), shaft_at(stop.end().position), "{slow}");

        for demand in [0.1, -0.1] {
            let again = run(&mut caught.clone(), demand, 10);
            let fresh = run(&mut drive(&rough(), 1000.0), demand, 10);
            assert_eq!(again[0].start, shaft_at(stop.end().position), "{slow}");
            for (again, fresh) in again.iter().zip(&fresh) {
                assert_eq!(again.start.velocity, fresh.start.velocity);
                assert_eq!(again.jerk, fresh.jerk, "{slow} then {demand}");
            }
        }
    }
}
