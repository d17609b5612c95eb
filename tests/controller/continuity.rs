//! No kick: at enable the output starts from zero, at a change of parameters from where it was.

use leadscrew::controller::config::Gains;
use leadscrew::controller::{Config, Controller};
use leadscrew::units::Command;
use proptest::prelude::*;

use crate::seeded::seeded;
use crate::signals::{LSB, NOT_LIMITED, config, controller, demand, demanded, standing};

/// Position gain alone; the law is then `gain·error`.
fn proportional(position: f64) -> Gains {
    Gains {
        position,
        ..Gains::default()
    }
}

#[test]
fn the_first_demand_is_zero_and_the_law_is_let_in_with_the_stated_time_constant() {
    for transfer_ticks in [1.0, 20.0, 50.0, 1000.0] {
        let mut controller = controller(proportional(0.01), transfer_ticks);
        let signals = standing(40.0);
        assert_eq!(demanded(&mut controller, &signals), 0.0);
        for tick in 1..5000 {
            let seen = demanded(&mut controller, &signals);
            let expected = 0.4 * (1.0 - (-f64::from(tick) / transfer_ticks).exp());
            // An LSB of rounding each tick, which decays with the same time constant, and that of the law.
            assert!(
                (seen - expected).abs() <= (transfer_ticks + 2.0) * LSB,
                "tick {tick}: {seen} instead of {expected}"
            );
        }
    }
}

#[test]
fn what_is_let_in_ends_at_the_law_exactly() {
    // Rounding towards zero: no remainder of the jump stays, whatever the time constant. From 0.4 of full
    // command, 4.3e8 LSB, a time constant of T ticks leaves less than T LSB after T·ln(4.3e8/T), and these
    // lose one a tick.
    let mut settled = controller(proportional(0.01), 200.0);
    demanded(&mut settled, &standing(0.0));
    let law = (0..10_000)
        .map(|_| demanded(&mut settled, &standing(40.0)))
        .last()
        .unwrap();
    let mut transferred = controller(proportional(0.01), 200.0);
    let last = (0..10_000)
        .map(|_| demanded(&mut transferred, &standing(40.0)))
        .last()
        .unwrap();
    assert_eq!(last, law);
}

#[test]
fn reset_starts_from_zero_again() {
    let gains = Gains {
        integral: 1e-5,
        ..proportional(0.01)
    };
    let mut used = controller(gains, 10.0);
    for _ in 0..500 {
        demanded(&mut used, &standing(-25.0));
    }
    used.reset();
    let mut fresh = controller(gains, 10.0);
    for tick in 0..100 {
        let signals = standing(f64::from(tick));
        assert_eq!(
            demanded(&mut used, &signals),
            demanded(&mut fresh, &signals)
        );
    }
}

fn any_config() -> impl Strategy<Value = Config> {
    let gain = || prop_oneof![Just(0.0), 0.0..0.05_f64];
    (
        gain(),
        0.0..1e-4_f64,
        gain(),
        0.0..10.0_f64,
        -0.3..0.3_f64,
        1.0..300.0_f64,
    )
        .prop_map(
            |(position, integral, derivative, deadband, bias, transfer)| {
                let gains = Gains {
                    position,
                    integral,
                    derivative,
                    ..Gains::default()
                };
                config(&gains, deadband, bias, transfer)
            },
        )
}

proptest! {
    #![proptest_config(seeded(512))]

    #[test]
    fn the_demand_after_a_change_of_parameters_is_the_output_before_it(
        before in any_config(),
        after in any_config(),
        // Up to laws far beyond saturation.
        errors in prop::collection::vec(-3e4..3e4_f64, 1..30),
        output in -(1 << 30)..=1 << 30_i32,
    ) {
        let output = Command::from_bits(output);
        let mut controller = Controller::new(before);
        for error in &errors {
            demanded(&mut controller, &standing(*error));
        }
        controller.reconfigure(after, output);
        prop_assert_eq!(demand(&mut controller, &standing(errors[0]), NOT_LIMITED), output);
    }
}

/// The largest change of the demand from one tick to the next while an error grows by 1/8 d a tick and the
/// parameters change at tick 100.
fn largest_step(before: Config, after: Config) -> f64 {
    let mut controller = Controller::new(before);
    let mut last = demand(&mut controller, &standing(0.0), NOT_LIMITED);
    let mut largest = 0.0_f64;
    for tick in 1..300 {
        if tick == 100 {
            controller.reconfigure(after, last);
        }
        let now = demand(
            &mut controller,
            &standing(0.125 * f64::from(tick)),
            NOT_LIMITED,
        );
        // The derivative's own entry at the start of the ramp is no matter of the change.
        if tick > 50 {
            largest = largest.max((now - last).to_num::<f64>().abs());
        }
        last = now;
    }
    largest
}

#[test]
fn a_change_of_parameters_steps_neither_at_once_nor_in_the_tick_after() {
    let with = |derivative, deadband| {
        let gains = Gains {
            position: 1e-3,
            derivative,
            ..Gains::default()
        };
        config(&gains, deadband, 0.0, 50.0)
    };
    // The proportional term alone moves by 1.25e-4 a tick. The jump of the law (the derivative's share, which falls
    // from 0.0625 to 0.0125; 3 d of deadband, worth 0.003) comes in over 50 ticks: at most a fiftieth of it in one.
    let ramp = 1.25e-4;
    for (before, after, jump) in [
        (with(0.5, 0.0), with(0.5, 0.0), ramp),
        (with(0.5, 0.0), with(0.1, 0.0), 0.05 + ramp),
        (with(0.5, 0.0), with(0.5, 3.0), 0.003 + ramp),
        (with(0.5, 3.0), with(0.5, 0.0), 0.003 + ramp),
    ] {
        let largest = largest_step(before, after);
        assert!(largest <= ramp + jump / 50.0 + 3.0 * LSB, "{largest}");
    }
}
