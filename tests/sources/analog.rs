//! The analog command: offset, deadband, scale, and limits whatever is read.

use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::analog::{Analog, AnalogParams};
use leadscrew::setpoint::profile::Limits;
use leadscrew::units::{AxisScale, Command, Position, Velocity};
use proptest::prelude::*;

use crate::seeded::seeded;

fn limits() -> Limits {
    Limits::new(150.0, 0.9, 0.01).unwrap()
}

fn analog(params: &AnalogParams) -> Analog {
    let scale = AxisScale::new(1000.0, 1000.0).unwrap();
    let config = params.quantise(scale, limits().velocity()).unwrap();
    Analog::new(config, &limits())
}

fn params() -> AnalogParams {
    AnalogParams {
        analog_full_scale_mm_per_min: 6000.0,
        analog_offset: 0.01,
        analog_deadband: 0.005,
    }
}

/// The velocity that a command settles at.
fn settled(params: &AnalogParams, command: f64) -> f64 {
    let mut source = analog(params);
    let step = |source: &mut Analog| source.step(Command::from_num(command));
    let last = (0..2000).map(|_| step(&mut source)).last().unwrap();
    assert_eq!(last.acceleration, 0);
    last.velocity.to_num()
}

#[test]
fn offset_and_deadband_are_taken_out_and_full_scale_is_the_feed_set() {
    let params = params();
    for (command, velocity) in [
        (0.01, 0.0),
        (0.014_9, 0.0),
        (0.005_1, 0.0),
        // Not a step at the border: 0.0001 of full scale beyond it.
        (0.015_1, 100.0 * 0.000_1 / 0.995),
        (0.004_9, -100.0 * 0.000_1 / 0.995),
        (1.01, 100.0),
        (-0.99, -100.0),
    ] {
        let found = settled(&params, command);
        assert!((found - velocity).abs() < 2e-6, "{found} at {command}");
    }
}

#[test]
fn the_axis_goes_no_faster_than_it_may() {
    let fast = AnalogParams {
        analog_full_scale_mm_per_min: -12_000.0,
        ..params()
    };
    assert_eq!(settled(&fast, 1.5), -150.0);
}

#[test]
fn a_control_that_falls_silent_brings_the_axis_to_rest() {
    let mut source = analog(&params());
    source.start(Position::from_num(12.5));
    for _ in 0..1000 {
        source.step(Command::from_num(0.7));
    }
    assert!(source.is_moving());
    for _ in 0..1000 {
        source.step(Command::from_num(0.01));
    }
    assert!(!source.is_moving());
}

#[test]
fn parameters_are_refused_by_name() {
    let scale = AxisScale::new(1000.0, 1000.0).unwrap();
    let refused = AnalogParams {
        analog_deadband: 0.3,
        ..params()
    };
    let error = refused.quantise(scale, Velocity::from_num(1)).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("analog_deadband = 0.3 is out of range")
    );
}

proptest! {
    #![proptest_config(seeded(100))]

    #[test]
    fn any_commands_keep_the_limits(
        commands in prop::collection::vec((any::<i32>(), 1..200_u32), 1..30),
        offset in -0.5..0.5_f64,
        deadband in 0.0..0.2_f64,
        feed in -1e5..1e5_f64,
    ) {
        let mut source = analog(&AnalogParams {
            analog_full_scale_mm_per_min: feed,
            analog_offset: offset,
            analog_deadband: deadband,
        });
        let mut last = Setpoint::default();
        for (bits, ticks) in commands {
            for _ in 0..ticks {
                let next = source.step(Command::from_bits(bits));
                prop_assert!(next.velocity.abs() <= limits().velocity());
                prop_assert!(next.acceleration.abs() <= limits().acceleration());
                let jerk = (next.acceleration - last.acceleration).to_num::<f64>();
                prop_assert!(jerk.abs() <= 0.01 + 1e-6, "{jerk}");
                last = next;
            }
        }
    }
}
