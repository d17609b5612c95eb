//! The compensation in the axis: no kick, no disturbance of the loop, and what users are told.

use leadscrew::axis::{Axis, Inputs};
use leadscrew::compensation::{CompensationParams, ScrewTable};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Capture;
use leadscrew::params::{AxisConfig, AxisParams, ControllerParams};
use leadscrew::units::{Command, Position};

use crate::motion::{memory, point, with_backlash};

fn config(compensation: CompensationParams) -> AxisConfig {
    AxisParams {
        compensation,
        controller: ControllerParams {
            position_gain_per_s: 30.0,
            integral_gain_per_s2: 100.0,
            ..ControllerParams::default()
        },
        ..AxisParams::new(EstimatorConfig::by_name("exponential").unwrap().unwrap())
    }
    .validate()
    .unwrap()
}

fn still(count: i32, enable: bool) -> Inputs<'static> {
    let capture = Capture {
        count: count.cast_unsigned(),
        ..Capture::default()
    };
    Inputs::of(capture, enable)
}

#[test]
fn an_origin_without_anything_to_compensate_changes_no_bit_of_the_loop() {
    let mut plain = Axis::new(config(CompensationParams::default()));
    let mut homed = plain.clone();
    for tick in 0..500 {
        if tick == 100 {
            homed.set_origin(Some(Position::from_num(4000.25)));
        }
        let inputs = still(1000 + tick % 7, tick > 20);
        let (expected, mut got) = (*plain.step(&inputs), *homed.step(&inputs));
        let origin = if tick < 100 { 0.0 } else { 4000.25 };
        assert_eq!(expected.reported - got.reported, Position::from_num(origin));
        got.reported = expected.reported;
        assert_eq!(got, expected);
    }
}

#[test]
fn an_axis_is_enabled_where_it_stands_whatever_is_compensated_there() {
    let mut memory = memory();
    let points: Vec<_> = (0..256)
        .map(|at| point(f64::from(at) * 1000.0, f64::from(at % 2) * 1.5, 3.0))
        .collect();
    let table = ScrewTable::build(&points, &mut memory).unwrap();
    let mut axis = Axis::new(config(with_backlash(0.004)));
    axis.set_screw_table(Some(table)).unwrap();
    axis.set_origin(Some(Position::from_num(-77)));
    axis.step(&still(0, false));
    // Turned by hand through the whole table in a few ticks.
    for count in [100_000, 200_000, 151_423] {
        axis.step(&still(count, false));
    }
    axis.step(&still(151_423, false));
    for _ in 0..100 {
        let outputs = axis.step(&still(151_423, true));
        assert_eq!(outputs.command, Command::ZERO);
        assert!(outputs.following_error.to_num::<f64>().abs() < 1e-4);
        let place = outputs.reported.to_num::<f64>();
        // Place 151 500.5: in the middle between the points 151 (1.5 d) and 152 (0 d); half the backlash.
        let amount = 2.0 - 0.75;
        assert!((place - (151_500.5 - amount)).abs() < 0.01, "{place}");
    }
}

#[test]
fn a_table_that_parameters_leave_no_room_for_is_let_go_with_them() {
    let mut memory = memory();
    let points = [point(0.0, 0.0, 0.0), point(1000.0, 1.0, 1.0)];
    let table = ScrewTable::build(&points, &mut memory).unwrap();
    let mut axis = Axis::new(config(with_backlash(0.0)));
    axis.set_screw_table(Some(table)).unwrap();
    axis.reconfigure(&config(with_backlash(0.001))).unwrap();
    assert!(axis.compensation().table().is_some());
    axis.reconfigure(&config(CompensationParams::default()))
        .unwrap();
    assert!(axis.compensation().table().is_none());
}
