//! Where the axis counts from: homing, the origin, and what is known from there.

use super::{Axis, Inputs};
use crate::capture::Observation;
use crate::compensation::{Compensation, ScrewTable, TableRefused};
use crate::homing::{HomeRefused, Homing, Sight};
use crate::supervisor::{Fault, Permit, State};
use crate::units::Position;

impl<'m> Axis<'m> {
    /// A tick of homing, or its end where it may not go on: the sources go on from there.
    #[cold]
    pub(super) fn step_homing(
        &mut self,
        observation: &Observation<'_>,
        inputs: &Inputs<'_>,
        permit: Permit,
    ) {
        if permit < Permit::Follow {
            self.homing.abort();
            let tick = self.tick.wrapping_sub(1);
            self.sources.advance_else(tick, &inputs.reference, permit);
            return;
        }
        let setpoint = self.homing.step(&Sight {
            observation,
            lines: &inputs.lines,
            index_error: self.edges.index_error(observation),
        });
        self.sources.take_over(&setpoint);
        self.count_from(self.homing.origin());
    }

    /// Begins homing with the next tick. The origin of before is given up, and with it, by its slew, the
    /// compensation of the screw.
    ///
    /// # Errors
    /// [`HomeRefused`] unless the axis is ready and at rest.
    pub fn home(&mut self) -> Result<(), HomeRefused> {
        if self.outputs.state != State::Ready || self.outputs.moving {
            return Err(HomeRefused::NotReady);
        }
        if !self.config.homing.has_index() {
            return Err(HomeRefused::NoIndex);
        }
        self.homing.start(self.sources.last(), self.outputs.count);
        self.count_from(None);
        Ok(())
    }

    /// Homing: where it stands, what it found, and why it failed.
    #[must_use]
    pub const fn homing(&self) -> &Homing {
        &self.homing
    }

    /// Takes a screw error table between two ticks, or does without. It comes into force by the compensation's slew as
    /// soon as an origin is known.
    ///
    /// # Errors
    /// [`TableRefused`] if the compensation cannot follow it at the largest feed; the one before stays.
    pub fn set_screw_table(&mut self, table: Option<ScrewTable<'m>>) -> Result<(), TableRefused> {
        self.compensation.set_table(table)
    }

    /// The compensation of the screw, and the origin that it counts from.
    #[must_use]
    pub const fn compensation(&self) -> &Compensation<'m> {
        &self.compensation
    }

    /// The raw position of the zero of machine coordinates becomes known, or is lost, between two ticks: for an axis
    /// whose place is known without homing. The loop goes on as it was.
    pub fn set_origin(&mut self, origin: Option<Position>) {
        self.homing.set_origin(origin);
        self.count_from(origin);
    }

    /// Whether the place is still known: after an index, without the encoder's signals, and while a fault is latched.
    #[cold]
    #[inline(never)]
    pub(super) fn watch_place(&mut self, observation: &Observation<'_>, encoder_lost: bool) {
        let is_index_right = self.homing.check_index(observation);
        if encoder_lost || !is_index_right || self.outputs.fault.is_some_and(loses_place) {
            self.lose_place();
        }
    }

    /// The place of the axis is not known any more.
    fn lose_place(&mut self) {
        self.homing.lose_origin();
        self.count_from(None);
    }

    /// What lies at places of the machine begins to count from `origin`, or ends.
    pub(super) fn count_from(&mut self, origin: Option<Position>) {
        self.compensation.set_origin(origin);
        let travel = self.config.travel.as_ref().zip(origin);
        self.sources
            .set_travel(travel.map(|(travel, origin)| travel.from_origin(origin)));
    }
}

/// True for a fault after which the count may not tell the place any more.
const fn loses_place(fault: Fault) -> bool {
    matches!(
        fault,
        Fault::SignalLoss
            | Fault::IllegalTransitions
            | Fault::IndexInconsistent
            | Fault::EncoderLoss
    )
}
