//! The axis as what the tick computes: it takes requests, steps, and leaves what thread mode wants to see of the step.

mod look;
mod request;

pub use request::{Request, What};

use core::marker::PhantomData;

use leadscrew::axis::{Axis, Inputs};
use leadscrew::hal::Encoder;
use leadscrew::scope::{Scope, State, Stream};

use crate::captures::CaptureSender;
use crate::queues::TickEnds;
use crate::report::{Indexes, Report};
use crate::store::Interlock;
use crate::tick::Control;

/// Longest that thread mode may be behind while the axis moves, s: twice what a lease lasts.
const PATIENCE_S: f64 = 0.2;

/// What the axis sees of its board.
pub trait Inlet {
    /// Inputs of the tick, with enable asked for or not.
    fn inputs(&self, enable: bool) -> Inputs<'_>;
}

impl<E: Encoder> Inlet for E {
    /// A board without lines: all is well there.
    fn inputs(&self, enable: bool) -> Inputs<'_> {
        Inputs::of(self.capture(), enable)
    }
}

/// The axis, fed by the inputs of `B`.
pub struct AxisControl<B> {
    axis: Axis<'static>,
    ends: TickEnds,
    captures: CaptureSender,
    interlock: &'static Interlock,
    scope: Option<Scope<'static>>,
    stream: Option<Stream>,
    enable: bool,
    /// Ticks that thread mode may be behind while the axis moves.
    patience: u32,
    indexes: Indexes,
    /// Raw count at the last index.
    index_count: u32,
    /// The fault that was told, and how many came after it.
    told_fault: Option<(u32, u32)>,
    /// Touches and ends of the probe that were told.
    told_touch: (u16, u16),
    /// The tick that comes next.
    tick: u32,
    /// Ticks missed since the last one.
    missed: u16,
    /// The last one ended too late.
    was_overlong: bool,
    board: PhantomData<fn(&B)>,
}

impl<B> AxisControl<B> {
    /// `interlock` keeps the axis off while the store is written.
    pub fn new(
        axis: Axis<'static>,
        ends: TickEnds,
        captures: CaptureSender,
        interlock: &'static Interlock,
    ) -> Self {
        Self {
            patience: (axis.config().scale.tick_hz() * PATIENCE_S) as u32,
            axis,
            ends,
            captures,
            interlock,
            scope: None,
            stream: None,
            enable: false,
            indexes: Indexes::default(),
            index_count: 0,
            told_fault: None,
            told_touch: (0, 0),
            tick: 0,
            missed: 0,
            was_overlong: false,
            board: PhantomData,
        }
    }

    /// The axis, before it ticks.
    pub(crate) const fn axis_mut(&mut self) -> &mut Axis<'static> {
        &mut self.axis
    }
}

impl<B: Inlet> Control for AxisControl<B> {
    type Inputs = B;
    type Record = Report;

    fn step(&mut self, board: &B) -> Report {
        self.take_requests();
        self.tick = self.tick.wrapping_add(1);
        // Whose lease nobody looks after does not move on.
        if self.axis.outputs().moving && self.ends.behind(self.tick) > self.patience {
            self.enable = false;
        }
        let enable = self.enable && self.interlock.try_enable();
        let mut inputs = board.inputs(enable);
        let missed = inputs.missed_ticks.saturating_add(self.missed);
        self.missed = 0;
        // The supervisor takes both for the same; what is recorded lacks only what was missed.
        let overlong = core::mem::take(&mut self.was_overlong).into();
        inputs.missed_ticks = missed.saturating_add(overlong);
        let outputs = self.axis.step(&inputs);
        if !(enable || outputs.enabled || outputs.brake_released) {
            self.interlock.disabled();
        }
        self.look(&inputs.capture);
        self.note_index(&inputs.capture);
        Report {
            indexes: self.indexes,
            missed,
            scope_triggered: (self.scope.as_ref())
                .is_some_and(|scope| scope.state() == State::Triggered),
            ..Report::of(&self.axis)
        }
    }

    /// Off, and off it stays until thread mode enables it anew: the axis does not know where it has got to.
    fn missed(&mut self) -> Report {
        self.enable = false;
        self.missed = self.missed.saturating_add(1);
        if let Some(scope) = &mut self.scope {
            scope.miss(1);
        }
        Report::of_missed_tick()
    }

    fn overlong(&mut self) {
        self.was_overlong = true;
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use leadscrew::axis;
    use leadscrew::estimator::EstimatorConfig;
    use leadscrew::hal::Capture;
    use leadscrew::params::AxisParams;
    use leadscrew::protocol::refusal::Refusal;
    use leadscrew::setpoint::planner::{Planner, Timed};
    use leadscrew::supervisor::SupervisorParams;
    use leadscrew::tuning::DriveModel;
    use leadscrew::units::Position;
    use std::boxed::Box;

    use super::*;
    use crate::queues::{LinkEnds, Queues};

    /// An encoder that stands at a count.
    struct Standing(u32);

    impl Encoder for Standing {
        fn capture(&self) -> Capture<'_> {
            Capture {
                count: self.0,
                ..Capture::default()
            }
        }
    }

    fn axis() -> Axis<'static> {
        // It is pushed as no machine is.
        axis_with(SupervisorParams::widest())
    }

    fn axis_with(supervisor: SupervisorParams) -> Axis<'static> {
        let drive = DriveModel::second_order(0.09, 0.5);
        let estimator = EstimatorConfig::by_name("simple").unwrap().unwrap();
        let params = AxisParams {
            controller: drive.place_poles(35.0).unwrap(),
            supervisor,
            ..AxisParams::new(estimator)
        };
        Axis::new(params.validate().unwrap())
    }

    const ENABLE: Request = Request::now(What::Enable(true));

    /// The axis in its tick, and thread mode's ends.
    fn control() -> (AxisControl<Standing>, LinkEnds) {
        control_of(axis())
    }

    fn control_of(axis: Axis<'static>) -> (AxisControl<Standing>, LinkEnds) {
        let queues: &'static mut Queues = Box::leak(Box::new(Queues::new()));
        let interlock: &'static Interlock = Box::leak(Box::new(Interlock::new()));
        let (tick, captures, link, _) = queues.split();
        (AxisControl::new(axis, tick, captures, interlock), link)
    }

    #[test]
    fn a_request_waits_for_its_tick_and_those_behind_it_with_it() {
        let (mut control, mut link) = control();
        let later = Request { at: 2, ..ENABLE };
        let refused = Request {
            ticket: 7,
            ..Request::now(What::Axis(axis::Request::Home))
        };
        assert!(link.requests.enqueue(later).is_ok() && link.requests.enqueue(refused).is_ok());
        let enabled = [0; 3].map(|_| control.step(&Standing(0)).record.drive().1);
        assert_eq!(enabled, [false, false, true]);
        let outcomes = [0; 3].map(|_| link.outcomes.dequeue());
        let [Some(first), Some(second), None] = outcomes else {
            panic!("{outcomes:?}")
        };
        assert_eq!((first.ticket, first.result), (0, Ok(())));
        let homing = (second.ticket, second.result);
        assert_eq!(
            homing,
            (7, Err(Refusal::NotReady)),
            "of an axis that is off"
        );
    }

    #[test]
    fn after_a_missed_tick_the_axis_is_off_until_it_is_enabled_anew() {
        let (mut control, mut link) = control();
        assert!(link.requests.enqueue(ENABLE).is_ok());
        control.step(&Standing(0));
        // Pushed away: the loop works against it.
        let working = (0..100).map(|_| control.step(&Standing(500))).last();
        let working = working.map(|report| report.record);
        assert!(working.is_some_and(|record| record.command < 0 && record.drive().1));

        assert_eq!(control.missed().record.drive().0.to_bits(), 0);
        for _ in 0..3 {
            let (command, enabled) = control.step(&Standing(500)).record.drive();
            assert_eq!((command.to_bits(), enabled), (0, false));
        }
        assert!(link.requests.enqueue(ENABLE).is_ok());
        let (command, enabled) = control.step(&Standing(500)).record.drive();
        assert_eq!((command.to_bits(), enabled), (0, true), "no kick");
    }

    #[test]
    fn ticks_that_end_too_late_are_a_fault_beyond_a_limit_and_no_gap_in_what_is_recorded() {
        let supervisor = SupervisorParams {
            missed_limit: 3.0,
            missed_forgiven_per_s: 1.0,
            ..SupervisorParams::widest()
        };
        let (mut control, mut link) = control_of(axis_with(supervisor));
        assert!(link.requests.enqueue(ENABLE).is_ok());
        let faults = [0; 6].map(|_| {
            let report = control.step(&Standing(0));
            assert_eq!(report.missed, 0);
            control.overlong();
            report.seen.fault
        });
        let late = Some(leadscrew::supervisor::Fault::LateTick);
        assert_eq!(faults, [None, None, None, None, late, late]);
    }

    #[test]
    fn an_axis_whose_store_is_written_is_not_enabled() {
        let (mut control, mut link) = control();
        let permission = control.interlock.permit(&axis::Outputs::default());
        assert!(link.requests.enqueue(ENABLE).is_ok());
        assert!(!control.step(&Standing(0)).record.drive().1);
        drop(permission);
        assert!(control.step(&Standing(0)).record.drive().1);
        let outputs = axis::Outputs::default();
        assert!(control.interlock.permit(&outputs).is_err());
        let off = Request::now(What::Enable(false));
        assert!(link.requests.enqueue(off).is_ok());
        (0..3000).for_each(|_| _ = control.step(&Standing(0)));
        assert!(control.interlock.permit(&outputs).is_ok());
    }

    #[test]
    fn a_moving_axis_stops_when_thread_mode_falls_silent() {
        let (mut control, mut link) = control();
        assert!(link.requests.enqueue(ENABLE).is_ok());
        let stands = (0..100).map(|_| control.step(&Standing(0))).last();
        let seen = stands.unwrap().seen;
        let mut planner = Planner::new(control.axis.config().limits, seen.commanded, seen.tick);
        let target = Position::from_num(500_000);
        let feed = control.axis.config().limits.velocity();
        let planned = planner.move_to(target, feed, seen.tick + 2).unwrap();
        let Some(Timed { plan, start }) = planned else {
            panic!("there is a way to go")
        };
        let queue = Request::now(What::Axis(axis::Request::Queue { plan, start }));
        assert!(link.requests.enqueue(queue).is_ok());
        let moves =
            |control: &mut AxisControl<Standing>, link: &LinkEnds, beats: bool, ticks: u32| {
                for _ in 0..ticks {
                    let report = control.step(&Standing(0));
                    if beats {
                        link.beat(report.seen.tick);
                    }
                }
                (control.axis.outputs().moving, control.enable)
            };
        // Without anybody who could fall silent it goes on; with somebody who does not, too.
        assert_eq!(moves(&mut control, &link, false, 300), (true, true));
        assert_eq!(moves(&mut control, &link, true, 300), (true, true));
        assert_eq!(moves(&mut control, &link, false, 199), (true, true));
        let (_, enable) = moves(&mut control, &link, false, 3);
        assert!(!enable);
    }
}
