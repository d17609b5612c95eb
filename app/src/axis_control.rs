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
    axis: Axis,
    requests: Consumer<'static, Request>,
    refused: &'static AtomicU32,
    enable: bool,
    encoder: PhantomData<fn(&E)>,
}

impl<E> AxisControl<E> {
    /// `refused` counts the requests that the axis did not take.
    pub const fn new(
        axis: Axis,
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
        let inputs = Inputs {
            capture: encoder.capture(),
            enable: self.enable,
        };
        Record::new(self.axis.step(&inputs))
    }

    fn missed(&mut self) -> Record {
        Record::default()
    }
}
