//! What probing does in each of its stages.

use super::trigger::Edge;
use super::{Probe, ProbeEnd, Sight, Stage};
use crate::capture::Observation;
use crate::units::{Position, Velocity};

impl Probe {
    /// Where the stage wants to go.
    pub(super) const fn target(&self) -> Velocity {
        let (speed, ahead) = match self.stage {
            Stage::Approach => (self.order.feed, true),
            Stage::Retract => (self.config.retract, false),
            Stage::Idle | Stage::Stop | Stage::Brake | Stage::Halt => return Velocity::ZERO,
        };
        let bits = speed.to_bits();
        if (self.direction > 0) == ahead {
            Velocity::from_bits(bits)
        } else {
            Velocity::from_bits(bits.wrapping_neg())
        }
    }

    pub(super) fn approach(&mut self, edge: Option<Edge>, was_closed: bool, sight: &Sight<'_>) {
        self.note_edge(sight);
        let stands = self.follower.is_at_rest();
        if was_closed || stands && sight.observation.is_touching() {
            self.trigger.close();
            return self.end_with(ProbeEnd::AlreadyTouching);
        }
        if edge.is_some() {
            self.settling = self.config.settle;
            self.stage = Stage::Stop;
        } else if self.has_arrived(self.order.target, self.direction) {
            self.end_with(ProbeEnd::NoTouch);
        }
    }

    pub(super) fn stop(&mut self, sight: &Sight<'_>) {
        if let Some(noted) = self.edge.take() {
            self.find(&noted, sight);
        }
        self.measure(sight);
        if !self.follower.is_at_rest() {
            return;
        }
        self.settling = self.settling.saturating_sub(1);
        if self.settling != 0 {
            return;
        }
        if self.order.retract > 0 {
            let way = self.direction.wrapping_mul(self.order.retract.to_bits());
            let from = self.follower.now().position;
            self.back = Position::from_bits(from.to_bits().wrapping_sub(way));
            self.stage = Stage::Retract;
        } else {
            self.finish(ProbeEnd::Touched);
        }
    }

    pub(super) fn retract(&mut self, edge: Option<Edge>) {
        if edge.is_some() {
            self.end_with(ProbeEnd::TouchedOnRetract);
        } else if self.has_arrived(self.back, self.direction.wrapping_neg()) {
            self.stage = Stage::Brake;
        }
    }

    pub(super) fn brake(&mut self, edge: Option<Edge>, observation: &Observation<'_>) {
        if edge.is_some() {
            self.end_with(ProbeEnd::TouchedOnRetract);
        } else if self.follower.is_at_rest() {
            self.finish(if observation.is_touching() {
                ProbeEnd::StillTouching
            } else {
                ProbeEnd::Touched
            });
        }
    }

    /// True if a stop that begins now ends at `place` in `direction`, or would pass it if it began a tick later.
    fn has_arrived(&self, place: Position, direction: i64) -> bool {
        let now = self.follower.now();
        let end = now
            .position
            .saturating_add(self.follower.stopping_distance(&now));
        let left = place.saturating_sub(end).to_bits().wrapping_mul(direction);
        let tick = i64::from(now.velocity.to_bits())
            .wrapping_abs()
            .wrapping_shr(Velocity::FRAC_NBITS - Position::FRAC_NBITS);
        left <= tick
    }

    /// Follows how far the axis goes on after the contact.
    pub(super) fn measure(&mut self, sight: &Sight<'_>) {
        if let Some(touch) = &mut self.touch {
            let gone = sight
                .observation
                .position()
                .saturating_sub(touch.raw)
                .to_bits();
            let gone = Position::from_bits(gone.wrapping_mul(self.direction));
            touch.overtravel = touch.overtravel.max(gone);
        }
    }

    fn end_with(&mut self, end: ProbeEnd) {
        self.end = end;
        self.stage = Stage::Halt;
    }
}
