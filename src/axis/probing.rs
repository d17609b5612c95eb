//! Probing, and what else commands the setpoint in place of the sources.

use super::{Axis, Inputs};
use crate::capture::Observation;
use crate::probe::{Probe, ProbeOrder, ProbeRefused, Sight};
use crate::supervisor::{Permit, State};
use crate::units::Position;

impl Axis<'_> {
    /// The setpoint of a tick in which homing or probing gives it, or in which the probe is watched; true while a motion is
    /// commanded.
    #[cold]
    #[inline(never)]
    pub(super) fn step_guided(
        &mut self,
        observation: &Observation<'_>,
        inputs: &Inputs<'_>,
        permit: Permit,
    ) -> bool {
        let tick = self.tick.wrapping_sub(1);
        if self.homing.is_active() {
            self.step_homing(observation, inputs, permit);
        } else if self.probe.is_active() && permit >= Permit::Follow {
            self.step_probe(observation);
        } else {
            self.probe.interrupt(inputs.lines.encoder_lost);
            self.sources.advance(tick, &inputs.reference, permit);
        }
        if self.has_probe && !self.probe.is_active() {
            self.watch_probe(observation);
        }
        self.sources.is_moving() || self.homing.is_active() || self.probe.is_active()
    }

    fn step_probe(&mut self, observation: &Observation<'_>) {
        let setpoint = self.probe.step(&Sight {
            observation,
            edges: &self.edges,
            estimate: &self.outputs.estimate,
            tick: self.tick.wrapping_sub(1),
        });
        self.sources.take_over(&setpoint);
        self.place_touch();
        self.has_probe = self.probe.is_awake();
    }

    /// Takes notice of the probe while something else moves the axis, or nothing does, and stops that where it shall.
    #[cold]
    #[inline(never)]
    pub(super) fn watch_probe(&mut self, observation: &Observation<'_>) {
        let is_moving = self.sources.is_moving() || self.homing.is_active();
        let stops = self.probe.watch(
            &Sight {
                observation,
                edges: &self.edges,
                estimate: &self.outputs.estimate,
                tick: self.tick.wrapping_sub(1),
            },
            is_moving && self.supervisor.is_following(),
        );
        if stops {
            self.homing.abort();
            self.probe.halt(self.sources.last());
        }
        self.place_touch();
        self.has_probe = self.probe.is_awake();
    }

    fn place_touch(&mut self) {
        if let Some(raw) = self.probe.unplaced() {
            self.probe.place(self.compensation.reported(raw));
        }
    }

    /// Begins to probe with the next tick. Gives how far the axis goes on after a contact at the most, d.
    ///
    /// # Errors
    /// [`ProbeRefused`]; nothing moves then.
    pub fn probe_towards(&mut self, order: &ProbeOrder) -> Result<Position, ProbeRefused> {
        match self.outputs.state {
            State::Ready if !self.outputs.moving => {}
            State::Ready | State::Moving => return Err(ProbeRefused::Moving),
            _ => return Err(ProbeRefused::NotReady),
        }
        let travel = self.sources.travel();
        let bound = self.probe.start(order, self.sources.last(), travel)?;
        self.has_probe = true;
        Ok(bound)
    }

    /// Probing: where it stands and what it came to.
    #[must_use]
    pub const fn probe(&self) -> &Probe {
        &self.probe
    }
}
