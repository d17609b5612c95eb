//! Faults shown by captures that a test makes up: an axis that is pushed while it stands or is off.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::hal::Capture;
use leadscrew::params::AxisParams;
use leadscrew::supervisor::{Fault, State};

use crate::rig::Plan;

struct Pushed {
    axis: Axis<'static>,
    count: u32,
}

impl Pushed {
    fn new(change: impl Fn(&mut AxisParams)) -> Self {
        let mut params = Plan::full().axis_params();
        // A loop without gains lets itself be pushed.
        params.controller = Default::default();
        params.motion.counts_per_revolution = 0.0;
        change(&mut params);
        Self {
            axis: Axis::new(params.validate().unwrap()),
            count: 0,
        }
    }

    fn step(&mut self, delta: i32, enable: bool) -> Outputs {
        self.count = self.count.wrapping_add_signed(delta);
        let capture = Capture {
            count: self.count,
            ..Capture::default()
        };
        *self.axis.step(&Inputs::of(capture, enable))
    }
}

#[test]
fn an_axis_pushed_at_rest_trips_beyond_two_tenths_once_it_has_settled() {
    let mut pushed = Pushed::new(|_| ());
    pushed.step(0, true);
    assert_eq!(pushed.step(300, true).fault, None, "not settled yet");
    pushed.step(-300, true);
    (0..600).for_each(|_| _ = pushed.step(0, true));
    (0..20).for_each(|_| assert_eq!(pushed.step(10, true).fault, None));
    let outputs = pushed.step(1, true);
    assert_eq!(outputs.fault, Some(Fault::MotionAtStandstill));
    assert_eq!((outputs.state, outputs.enabled), (State::Fault, true));
}

#[test]
fn motion_while_off_is_a_warning_or_a_fault_as_it_is_set() {
    for is_fault in [0.0, 1.0] {
        let mut pushed = Pushed::new(|params| params.supervisor.disabled_is_fault = is_fault);
        (0..1100).for_each(|_| _ = pushed.step(0, false));
        let outputs = pushed.step(100, false);
        assert!(outputs.warnings.is_empty() && outputs.fault.is_none());
        let outputs = pushed.step(1, false);
        let expected = Fault::MotionWhileDisabled;
        assert_eq!(outputs.warnings.contains(expected), is_fault == 0.0);
        assert_eq!(outputs.fault, (is_fault == 1.0).then_some(expected));
        let outputs = pushed.step(0, true);
        assert_eq!(outputs.enabled, is_fault == 0.0);
        assert_eq!(outputs.refused, is_fault == 1.0);
    }
}

#[test]
fn an_axis_that_runs_out_after_enable_is_no_motion_while_off() {
    let mut pushed = Pushed::new(|_| ());
    (0..10).for_each(|_| _ = pushed.step(0, true));
    for tick in 0..1500 {
        let outputs = pushed.step((1000 - tick).max(0) / 10, false);
        assert!(outputs.warnings.is_empty(), "tick {tick}");
    }
}

#[test]
fn overspeed_is_three_ticks_above_its_limit() {
    let mut pushed = Pushed::new(|params| {
        params.supervisor.following_error_mm = 1e6;
        params.supervisor.standstill_mm = 1e6;
        params.estimator = leadscrew::estimator::EstimatorConfig::by_name("difference")
            .unwrap()
            .unwrap();
    });
    (0..100).for_each(|_| _ = pushed.step(0, true));
    // 1.1 · 150 + 0.05 · 160 = 173 d/tick.
    (0..100).for_each(|_| assert_eq!(pushed.step(172, true).fault, None));
    (0..2).for_each(|_| assert_eq!(pushed.step(175, true).fault, None));
    let outputs = pushed.step(175, true);
    assert_eq!(outputs.fault, Some(Fault::Overspeed));
    assert_eq!((outputs.command.to_bits(), outputs.enabled), (0, true));
}
