//! The last stage: limit, slew, and which of them is active.

use leadscrew::output::{ActiveLimits, Config, Output};
use leadscrew::units::Command;
use proptest::prelude::*;

use crate::seeded::seeded;

fn output(limit: f64, slew: f64) -> Output {
    Output::new(Config::new(limit, slew).unwrap())
}

fn command(value: f64) -> Command {
    Command::from_num(value)
}

const NONE: ActiveLimits = ActiveLimits {
    high: false,
    low: false,
    slew: false,
};

#[test]
fn a_demand_within_limit_and_slew_passes_unchanged() {
    let mut output = output(0.5, 0.125);
    for demand in [0.0625, 0.1875, 0.25, 0.125, 0.0] {
        assert_eq!(output.step(command(demand)), command(demand));
        assert_eq!(
            (output.command(), output.active_limits()),
            (command(demand), NONE)
        );
    }
}

#[test]
fn the_limit_holds_on_both_sides_and_says_which() {
    let mut output = output(0.5, 2.0);
    assert_eq!(output.step(command(0.7)), command(0.5));
    assert_eq!(output.active_limits(), ActiveLimits { high: true, ..NONE });
    assert_eq!(output.step(command(0.5)), command(0.5));
    assert_eq!(
        output.active_limits(),
        NONE,
        "at the limit is not beyond it"
    );
    assert_eq!(output.step(command(-1.9)), command(-0.5));
    assert_eq!(output.active_limits(), ActiveLimits { low: true, ..NONE });
}

#[test]
fn the_slew_limits_the_change_of_a_tick_and_says_so() {
    let mut output = output(1.0, 0.25);
    for step in [0.25, 0.5, 0.75] {
        assert_eq!(output.step(command(1.0)), command(step));
        assert_eq!(
            output.active_limits(),
            ActiveLimits {
                high: true,
                slew: true,
                low: false
            }
        );
    }
    assert_eq!(output.step(command(1.0)), command(1.0));
    assert_eq!(output.active_limits(), NONE);
    assert_eq!(output.step(command(-1.0)), command(0.75));
    assert_eq!(
        output.active_limits(),
        ActiveLimits {
            low: true,
            slew: true,
            high: false
        }
    );
}

#[test]
fn off_is_zero_at_once_and_the_next_step_slews_from_there() {
    let mut output = output(1.0, 0.25);
    for _ in 0..4 {
        output.step(command(1.0));
    }
    assert_eq!(output.off(), Command::ZERO);
    assert_eq!(
        (output.command(), output.active_limits()),
        (Command::ZERO, NONE)
    );
    assert_eq!(output.step(command(1.0)), command(0.25));
}

#[test]
fn a_lowered_limit_is_reached_with_the_new_slew() {
    let mut output = output(1.0, 2.0);
    output.step(command(0.9));
    output.reconfigure(Config::new(0.5, 0.125).unwrap());
    for expected in [0.775, 0.65, 0.525, 0.5, 0.5] {
        assert!((output.step(command(0.9)) - command(expected)).abs() <= Command::DELTA);
        assert!(output.active_limits().high);
    }
}

#[test]
fn limits_out_of_range_are_refused_by_name_value_and_range() {
    for (limit, slew, name, value, min, max) in [
        (0.0, 0.1, "output_limit", 0.0, 1e-4, 1.0),
        (1.01, 0.1, "output_limit", 1.01, 1e-4, 1.0),
        (0.5, 0.0, "output_slew_per_tick", 0.0, 1e-6, 2.0),
        (0.5, 2.5, "output_slew_per_tick", 2.5, 1e-6, 2.0),
    ] {
        let error = Config::new(limit, slew).unwrap_err();
        assert_eq!(
            (error.name, error.value, error.min, error.max),
            (name, value, min, max)
        );
    }
    assert!(Config::new(f64::NAN, 0.1).is_err() && Config::new(0.5, f64::NAN).is_err());
}

proptest! {
    #![proptest_config(seeded(512))]

    #[test]
    fn no_demand_passes_limit_or_slew_and_the_flags_tell_the_truth(
        limit in 1e-4..1.0_f64,
        slew in prop_oneof![Just(2.0), 1e-6..2.0_f64],
        demands in prop::collection::vec(any::<i32>(), 1..100),
    ) {
        let mut output = output(limit, slew);
        // Both are kept to the nearest LSB.
        let (limit, slew) = (command(limit), Command::saturating_from_num(slew));
        let mut before = Command::ZERO;
        for demand in demands.into_iter().map(Command::from_bits) {
            let seen = output.step(demand);
            prop_assert!(seen.abs() <= limit);
            prop_assert!(seen.to_bits().abs_diff(before.to_bits()) <= slew.to_bits().unsigned_abs());
            let active = output.active_limits();
            prop_assert_eq!((active.high, active.low), (demand > seen, demand < seen));
            prop_assert_eq!(active.slew, demand.clamp(-limit, limit) != seen);
            before = seen;
        }
    }
}
