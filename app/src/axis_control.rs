//! The axis as what the tick computes.

use core::marker::PhantomData;
use core::sync::atomic::{AtomicU32, Ordering};

use heapless::spsc::Consumer;
use leadscrew::axis::{self, Axis, Inputs};
use leadscrew::hal::Encoder;
use leadscrew::telemetry::Record;

use crate::tick::Control;

/// What thread mode asks for, and when.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    /// The tick that is to be the first to see it, counted from 0; one that has passed is the next.
    pub at: u32,
    /// What.
    pub what: What,
}

/// What thread mode asks for.
#[derive(Clone, Copy, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "a queue of them is a static, and there is no heap"
)]
pub enum What {
    /// Puts the axis under control, or takes it out.
    Enable(bool),
    /// A request to the axis.
    Axis(axis::Request),
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
    requests: Consumer<'static, Request>,
    refused: &'static AtomicU32,
    enable: bool,
    /// The tick that comes next.
    tick: u32,
    /// Ticks missed since the last one.
    missed: u16,
    board: PhantomData<fn(&B)>,
}

impl<B> AxisControl<B> {
    /// `refused` counts the requests that the axis did not take.
    pub const fn new(
        axis: Axis<'static>,
        requests: Consumer<'static, Request>,
        refused: &'static AtomicU32,
    ) -> Self {
        Self {
            axis,
            requests,
            refused,
            enable: false,
            tick: 0,
            missed: 0,
            board: PhantomData,
        }
    }

    /// Takes what is due; the queue bounds how much that can be.
    fn take_requests(&mut self) {
        while let Some(next) = self.requests.peek()
            && next.at.wrapping_sub(self.tick).cast_signed() <= 0
        {
            let is_taken = match &next.what {
                What::Enable(enable) => {
                    self.enable = *enable;
                    true
                }
                What::Axis(request) => self.axis.take(request).is_ok(),
            };
            // In place until here: a plan is large.
            let _ = self.requests.dequeue();
            if !is_taken {
                let refused = self.refused.load(Ordering::Relaxed);
                self.refused
                    .store(refused.wrapping_add(1), Ordering::Relaxed);
            }
        }
    }
}

impl<B: Inlet> Control for AxisControl<B> {
    type Inputs = B;
    type Record = Record;

    fn step(&mut self, board: &B) -> Record {
        self.take_requests();
        self.tick = self.tick.wrapping_add(1);
        let mut inputs = board.inputs(self.enable);
        inputs.missed_ticks = inputs.missed_ticks.saturating_add(self.missed);
        self.missed = 0;
        Record::new(self.axis.step(&inputs))
    }

    /// Off, and off it stays until thread mode enables it anew: the axis does not know where it has got to.
    fn missed(&mut self) -> Record {
        self.enable = false;
        self.missed = self.missed.saturating_add(1);
        Record::default()
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::boxed::Box;

    use heapless::spsc::Queue;
    use leadscrew::estimator::EstimatorConfig;
    use leadscrew::hal::Capture;
    use leadscrew::params::AxisParams;
    use leadscrew::supervisor::SupervisorParams;
    use leadscrew::tuning::DriveModel;

    use super::*;

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

    const ENABLE: Request = Request {
        at: 0,
        what: What::Enable(true),
    };

    #[test]
    fn a_request_waits_for_its_tick_and_those_behind_it_with_it() {
        static REFUSED: AtomicU32 = AtomicU32::new(0);
        let queue: &'static mut Queue<Request, 4> = Box::leak(Box::new(Queue::new()));
        let (mut ask, asked) = queue.split();
        let mut control = AxisControl::new(axis(), asked, &REFUSED);
        let later = Request { at: 2, ..ENABLE };
        let refused = Request {
            at: 0,
            what: What::Axis(axis::Request::Home),
        };
        assert!(ask.enqueue(later).is_ok() && ask.enqueue(refused).is_ok());
        let enabled = [0; 3].map(|_| control.step(&Standing(0)).drive().1);
        assert_eq!(enabled, [false, false, true]);
        assert_eq!(
            REFUSED.load(Ordering::Relaxed),
            1,
            "homing of an axis that is off"
        );
    }

    #[test]
    fn after_a_missed_tick_the_axis_is_off_until_it_is_enabled_anew() {
        static REFUSED: AtomicU32 = AtomicU32::new(0);
        let queue: &'static mut Queue<Request, 4> = Box::leak(Box::new(Queue::new()));
        let (mut ask, asked) = queue.split();
        let mut control = AxisControl::new(axis(), asked, &REFUSED);
        assert!(ask.enqueue(ENABLE).is_ok());
        control.step(&Standing(0));
        // Pushed away: the loop works against it.
        let working = (0..100).map(|_| control.step(&Standing(500))).last();
        assert!(working.is_some_and(|record| record.command < 0 && record.drive().1));

        assert_eq!(control.missed().drive().0.to_bits(), 0);
        for _ in 0..3 {
            let (command, enabled) = control.step(&Standing(500)).drive();
            assert_eq!((command.to_bits(), enabled), (0, false));
        }
        assert!(ask.enqueue(ENABLE).is_ok());
        let (command, enabled) = control.step(&Standing(500)).drive();
        assert_eq!((command.to_bits(), enabled), (0, true), "no kick");
    }
}
