//! What an origin outlives and what it does not, and that it does not disturb the loop.

use leadscrew::axis::{Axis, Inputs};
use leadscrew::hal::{Capture, Latch, Lines};
use leadscrew::homing::HomingParams;
use leadscrew::units::Position;

use crate::rig::{Rig, Switches, axis_params, real};

fn axis() -> Axis<'static> {
    let params = axis_params(&real(), HomingParams::default());
    let mut axis = Axis::new(params.validate().unwrap());
    axis.set_origin(Some(Position::from_num(5)));
    axis
}

fn at(count: i32, index: Option<i32>) -> Capture<'static> {
    Capture {
        count: count.cast_unsigned(),
        index: index.map(|count| Latch {
            count: count.cast_unsigned(),
            time: 0,
        }),
        ..Capture::default()
    }
}

fn is_homed(axis: &Axis<'_>) -> bool {
    assert_eq!(axis.homing().origin(), axis.compensation().origin());
    axis.homing().origin().is_some()
}

#[test]
fn the_origin_is_kept_while_the_drive_is_off() {
    let mut rig = Rig::new(&real(), HomingParams::default(), Switches::at(33_000.0), 1);
    rig.home();
    let origin = rig.origin();
    let count = rig.outputs.count as i32;
    for tick in 0..500 {
        let inputs = Inputs::of(at(count, None), tick > 400);
        rig.axis.step(&inputs);
    }
    assert_eq!(rig.origin(), origin);
}

#[test]
fn a_lost_signal_loses_the_origin() {
    let mut axis = axis();
    axis.step(&Inputs::of(at(0, None), false));
    assert!(is_homed(&axis));
    let lines = Lines {
        encoder_lost: true,
        ..Lines::default()
    };
    axis.step(&Inputs {
        lines,
        ..Inputs::of(at(0, None), false)
    });
    assert!(!is_homed(&axis));
}

#[test]
fn an_index_off_whole_revolutions_loses_the_origin() {
    for (second, keeps) in [
        (30_000, true),
        (30_002, true),
        (30_004, false),
        (29_995, false),
    ] {
        let mut axis = axis();
        axis.step(&Inputs::of(at(9_990, None), false));
        axis.step(&Inputs::of(at(10_010, Some(10_000)), false));
        // Backward the other front of the pulse latches.
        axis.step(&Inputs::of(at(9_990, Some(10_003)), false));
        for count in (10_000..29_000).step_by(1000) {
            axis.step(&Inputs::of(at(count, None), false));
        }
        axis.step(&Inputs::of(at(second - 8, None), false));
        axis.step(&Inputs::of(at(second + 8, Some(second)), false));
        assert_eq!(is_homed(&axis), keeps, "{second}");
    }
}

#[test]
fn homing_itself_disturbs_the_loop_no_more_than_the_same_motion_without_a_coordinate() {
    // Two runs that differ in the coordinate alone give the same commands, bit for bit.
    let run = |home_position_mm| {
        let homing = HomingParams {
            home_position_mm,
            ..HomingParams::default()
        };
        let mut rig = Rig::new(&real(), homing, Switches::at(33_000.0), 2);
        rig.run(200);
        rig.axis.home().unwrap();
        let outputs: Vec<_> = (0..20_000).map(|_| rig.step()).collect();
        assert!(rig.origin().is_some());
        outputs
    };
    let (here, there) = (run(0.0), run(777.25));
    let mut apart = 0;
    for (here, there) in here.iter().zip(&there) {
        assert_eq!(
            (here.command, here.setpoint),
            (there.command, there.setpoint)
        );
        apart += usize::from(here.reported != there.reported);
    }
    assert!(apart > 1000, "the coordinates differ in {apart} ticks");
}

#[test]
fn soft_limits_count_from_the_origin_as_soon_as_it_is_known() {
    let mut params = axis_params(&real(), HomingParams::default());
    params.motion.travel_low_mm = -60.0;
    params.motion.travel_high_mm = 10.0;
    let mut rig = Rig::with_axis(&real(), &params, Switches::at(33_000.0), 1);
    rig.run(200);
    assert_eq!(rig.axis.travel(), None);
    rig.axis.home().unwrap();
    while rig.step().moving {}
    let limits = params.validate().unwrap().travel.unwrap();
    assert_eq!(
        rig.axis.travel(),
        Some(limits.from_origin(Position::from_num(rig.origin().unwrap())))
    );
    rig.axis.set_origin(None);
    assert_eq!(rig.axis.travel(), None);
}
