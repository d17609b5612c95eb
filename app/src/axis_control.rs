//! The axis as what the tick computes.

use core::marker::PhantomData;
use core::sync::atomic::{AtomicU32, Ordering};

use heapless::spsc::Consumer;
use leadscrew::axis::{Axis, Inputs};
use leadscrew::hal::Encoder;
use leadscrew::setpoint::profile::Profile;
use leadscrew::telemetry::Record;

use crate::tick::Control;

/// What thread mode asks of the axis; one request is taken a tick, before its step.
#[derive(Clone, Copy, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "a queue of them is a static, and there is no heap"
)]
pub enum Request {
    /// Puts the axis under control, or takes it out.
    Enable(bool),
    /// Starts a planned move at a tick.
    Move {
        /// The move.
        profile: Profile,
        /// Tick of its start.
        start: u32,
    },
}

/// The axis, fed by the captures of `E`.
pub struct AxisControl<E> {
    axis: Axis<'static>,
    requests: Consumer<'static, Request>,
    refused: &'static AtomicU32,
    enable: bool,
    encoder: PhantomData<fn(&E)>,
}

impl<E> AxisControl<E> {
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
            encoder: PhantomData,
        }
    }

    fn take_request(&mut self) {
        match self.requests.dequeue() {
            Some(Request::Enable(enable)) => self.enable = enable,
            Some(Request::Move { profile, start }) if self.axis.queue(&profile, start).is_err() => {
                let refused = self.refused.load(Ordering::Relaxed);
                self.refused
                    .store(refused.wrapping_add(1), Ordering::Relaxed);
            }
            Some(Request::Move { .. }) | None => {}
        }
    }
}

impl<E: Encoder> Control for AxisControl<E> {
    type Inputs = E;
    type Record = Record;

    fn step(&mut self, encoder: &E) -> Record {
        self.take_request();
        let inputs = Inputs::of(encoder.capture(), self.enable);
        Record::new(self.axis.step(&inputs))
    }

    /// Off, and off it stays until thread mode enables it anew: the axis does not know where it has got to.
    fn missed(&mut self) -> Record {
        self.enable = false;
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

    #[test]
    fn after_a_missed_tick_the_axis_is_off_until_it_is_enabled_anew() {
        static REFUSED: AtomicU32 = AtomicU32::new(0);
        let queue: &'static mut Queue<Request, 4> = Box::leak(Box::new(Queue::new()));
        let (mut ask, asked) = queue.split();
        let mut control = AxisControl::new(axis(), asked, &REFUSED);
        assert!(ask.enqueue(Request::Enable(true)).is_ok());
        control.step(&Standing(0));
        // Pushed away: the loop works against it.
        let working = (0..100).map(|_| control.step(&Standing(500))).last();
        assert!(working.is_some_and(|record| record.command < 0 && record.drive().1));

        assert_eq!(control.missed().drive().0.to_bits(), 0);
        for _ in 0..3 {
            let (command, enabled) = control.step(&Standing(500)).drive();
            assert_eq!((command.to_bits(), enabled), (0, false));
        }
        assert!(ask.enqueue(Request::Enable(true)).is_ok());
        let (command, enabled) = control.step(&Standing(500)).drive();
        assert_eq!((command.to_bits(), enabled), (0, true), "no kick");
    }
}
