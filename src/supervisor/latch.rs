//! The latch of the first fault.

use super::State;
use super::fault::Fault;
use super::fault_set::FaultSet;
use super::record::{Context, FirstFault, Trip};

/// The first fault, and what came after it.
#[derive(Clone, Debug, Default)]
pub(super) struct Latch {
    first: Option<FirstFault>,
    /// The first fault was found in this tick; its context is still to come.
    is_due: bool,
}

impl Latch {
    pub const fn fault(&self) -> Option<Fault> {
        match &self.first {
            Some(first) => Some(first.trip.fault),
            None => None,
        }
    }

    pub const fn first(&self) -> Option<&FirstFault> {
        self.first.as_ref()
    }

    pub const fn is_set(&self) -> bool {
        self.first.is_some()
    }

    pub const fn is_due(&self) -> bool {
        self.is_due
    }

    /// Latches what was found, or counts it if something is latched.
    pub fn set(&mut self, trip: Trip, tick: u32, state: State) {
        match &mut self.first {
            Some(first) if first.trip.fault == trip.fault => {}
            Some(first) => first.later = first.later.with(trip.fault),
            None => {
                self.is_due = true;
                self.first = Some(FirstFault {
                    trip,
                    tick,
                    state,
                    context: Context::default(),
                    later: FaultSet::default(),
                });
            }
        }
    }

    /// Takes the context that was due.
    pub fn note(&mut self, context: &Context) {
        self.is_due = false;
        if let Some(first) = &mut self.first {
            first.context = *context;
        }
    }

    pub fn clear(&mut self) {
        *self = Self::default();
    }
}
