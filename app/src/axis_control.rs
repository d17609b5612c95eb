//! The axis as what the tick computes.

use core::marker::PhantomData;

use leadscrew::axis::{self, Axis, Inputs};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::hal::{Capture, Encoder};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::service::Ticket;
use leadscrew::scope::{Scope, State, Stream};

use crate::captures::CaptureSender;
use crate::queues::{Outcome, TickEnds};
use crate::report::{Indexes, Report};
use crate::store::Interlock;
use crate::tick::Control;

/// What thread mode asks for, and when.
#[derive(Debug)]
pub struct Request {
    /// The tick that is to be the first to see it, counted from 0; one that has passed is the next.
    pub at: u32,
    /// Tells it from others, in its outcome.
    pub ticket: Ticket,
    /// What.
    pub what: What,
}

impl Request {
    /// One that the next tick is to see.
    #[must_use]
    pub const fn now(what: What) -> Self {
        Self {
            at: 0,
            ticket: 0,
            what,
        }
    }
}

/// What thread mode asks for.
#[derive(Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "a queue of them is a static, and there is no heap"
)]
pub enum What {
    /// Puts the axis under control, or takes it out.
    Enable(bool),
    /// A request to the axis.
    Axis(axis::Request),
    /// Takes a map of the encoder, or does without.
    SetMap(Option<EncoderMap<'static>>),
    /// The parameter store cannot be trusted, or can again.
    StoreCorrupt(bool),
    /// Hands captures to thread mode, or does not any more.
    Captures(bool),
    /// Gives samples of signals, or does not any more.
    Stream(Option<Stream>),
    /// Triggers the scope.
    TriggerScope,
    /// Ends the scope, which comes back.
    EndScope,
}

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
    indexes: Indexes,
    /// Raw count at the last index.
    index_count: u32,
    /// The fault that was told, and how many came after it.
    told_fault: Option<(u32, u32)>,
    /// The tick that comes next.
    tick: u32,
    /// Ticks missed since the last one.
    missed: u16,
    board: PhantomData<fn(&B)>,
}

impl<B> AxisControl<B> {
    /// `interlock` keeps the axis off while the store is written.
    pub const fn new(
        axis: Axis<'static>,
        ends: TickEnds,
        captures: CaptureSender,
        interlock: &'static Interlock,
    ) -> Self {
        Self {
            axis,
            ends,
            captures,
            interlock,
            scope: None,
            stream: None,
            enable: false,
            indexes: Indexes {
                number: 0,
                count: 0,
                distance: 0,
            },
            index_count: 0,
            told_fault: None,
            tick: 0,
            missed: 0,
            board: PhantomData,
        }
    }

    /// Takes what is due; the queues bound how much that can be.
    fn take_requests(&mut self) {
        while let Some(config) = self.ends.configs.dequeue() {
            let (ticket, config) = config;
            let result = self.axis.reconfigure(config).map_err(Refusal::from);
            self.answer(ticket, result);
        }
        if let Some(scope) = self.ends.scopes.dequeue() {
            self.scope = Some(scope);
        }
        while let Some(next) = self.ends.requests.peek()
            && next.at.wrapping_sub(self.tick).cast_signed() <= 0
        {
            let ticket = next.ticket;
            // In place until it is done: a plan is large.
            let result = match &next.what {
                What::Axis(request) => self.axis.take(request).map_err(Refusal::from),
                What::Enable(enable) => {
                    self.enable = *enable;
                    Ok(())
                }
                What::SetMap(map) => {
                    self.axis.set_map(*map);
                    Ok(())
                }
                What::StoreCorrupt(corrupt) => {
                    self.axis.supervisor_mut().set_store_corrupt(*corrupt);
                    Ok(())
                }
                What::Captures(is_open) => {
                    self.captures.open(*is_open);
                    Ok(())
                }
                What::Stream(stream) => {
                    self.stream.clone_from(stream);
                    Ok(())
                }
                What::TriggerScope => {
                    if let Some(scope) = &mut self.scope {
                        scope.trigger();
                    }
                    Ok(())
                }
                What::EndScope => {
                    if let Some(scope) = &mut self.scope {
                        scope.stop();
                    }
                    Ok(())
                }
            };
            let _ = self.ends.requests.dequeue();
            self.answer(ticket, result);
        }
    }

    fn answer(&mut self, ticket: Ticket, result: Result<(), Refusal>) {
        let outcome = Outcome { ticket, result };
        if self.ends.outcomes.enqueue(outcome).is_err() {
            self.ends.note_lost_outcome(result);
        }
    }

    /// Everything that looks at the axis after its step.
    fn look(&mut self, capture: &Capture<'_>) {
        if let Some(scope) = &mut self.scope {
            scope.take(&self.axis);
            if scope.is_over()
                && let Some(scope) = self.scope.take()
                // There is one scope at a time, so there is room.
                && let Err(scope) = self.ends.scopes_back.enqueue(scope)
            {
                self.scope = Some(scope);
            }
        }
        if let Some(stream) = &mut self.stream
            && let Some(sample) = stream.take(&self.axis)
        {
            // One that finds no room leaves a gap in the ticks.
            let _ = self.ends.samples.enqueue(sample);
        }
        self.captures.send(capture);
        if let Some(first) = self.axis.supervisor().first_fault() {
            let told = (first.tick, first.later.bits());
            if self.told_fault != Some(told) && self.ends.faults.enqueue(*first).is_ok() {
                self.told_fault = Some(told);
            }
        }
    }

    fn note_index(&mut self, capture: &Capture<'_>) {
        let Some(latch) = capture.index else {
            return;
        };
        let step = latch.count.wrapping_sub(self.index_count).cast_signed();
        let now = capture.count.wrapping_sub(latch.count).cast_signed();
        let count = self.axis.outputs().count.wrapping_sub(i64::from(now));
        self.indexes = Indexes {
            number: self.indexes.number.wrapping_add(1),
            count,
            distance: if self.indexes.number == 0 {
                0
            } else {
                i64::from(step)
            },
        };
        self.index_count = latch.count;
    }
}

impl<B: Inlet> Control for AxisControl<B> {
    type Inputs = B;
    type Record = Report;

    fn step(&mut self, board: &B) -> Report {
        self.take_requests();
        self.tick = self.tick.wrapping_add(1);
        let enable = self.enable && self.interlock.try_enable();
        let mut inputs = board.inputs(enable);
        inputs.missed_ticks = inputs.missed_ticks.saturating_add(self.missed);
        self.missed = 0;
        let outputs = self.axis.step(&inputs);
        if !(enable || outputs.enabled || outputs.brake_released) {
            self.interlock.disabled();
        }
        self.look(&inputs.capture);
        self.note_index(&inputs.capture);
        Report {
            indexes: self.indexes,
            missed: inputs.missed_ticks,
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
        Report::default()
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use leadscrew::estimator::EstimatorConfig;
    use leadscrew::hal::Capture;
    use leadscrew::params::AxisParams;
    use leadscrew::supervisor::SupervisorParams;
    use leadscrew::tuning::DriveModel;
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
        let drive = DriveModel::second_order(0.09, 0.5);
        let estimator = EstimatorConfig::by_name("simple").unwrap().unwrap();
        let params = AxisParams {
            controller: drive.place_poles(35.0).unwrap(),
            // It is pushed as no machine is.
            supervisor: SupervisorParams::widest(),
            ..AxisParams::new(estimator)
        };
        Axis::new(params.validate().unwrap())
    }

    const ENABLE: Request = Request::now(What::Enable(true));

    /// The axis in its tick, and thread mode's ends.
    fn control() -> (AxisControl<Standing>, LinkEnds) {
        let queues: &'static mut Queues = Box::leak(Box::new(Queues::new()));
        let interlock: &'static Interlock = Box::leak(Box::new(Interlock::new()));
        let (tick, captures, link, _) = queues.split();
        (AxisControl::new(axis(), tick, captures, interlock), link)
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
}
