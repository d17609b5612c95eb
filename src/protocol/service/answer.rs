//! What is done for each request.

use super::motion::Motion;
use super::{Done, Inner, Order, Port, Seen};
use crate::axis;
use crate::protocol::VERSION;
use crate::protocol::decoder::Dropped;
use crate::protocol::frame::Header;
use crate::protocol::parameters::{Which, parameter, write};
use crate::protocol::refusal::Refusal;
use crate::protocol::reply::{ENABLED, HELD, HOMED, LEASED, LEASED_HERE, MOVING, PLANNED, Reply};
use crate::protocol::request::Request;
use crate::supervisor::State;

impl Inner {
    pub(super) fn reply(seen: &Seen, outcome: Result<(), Refusal>) -> Reply<'static> {
        let tick = seen.tick;
        match outcome {
            Ok(()) => Reply::Ack { tick },
            Err(refusal) => Reply::Refused {
                tick,
                reason: refusal as u16,
            },
        }
    }

    pub(super) fn remember(&mut self, outcome: Result<(), Refusal>) -> Result<(), Refusal> {
        self.last_done = Done::Outcome(outcome);
        outcome
    }

    pub(super) fn hello(&self, seen: &Seen, nonce: u32) -> Reply<'static> {
        let identity = &self.identity;
        Reply::Hello {
            protocol: VERSION,
            nonce,
            session: self.session.number(),
            tick_hz: self.tick_hz,
            lease_ticks: self.lease.ticks(),
            tick: seen.tick,
            capabilities: identity.capabilities,
            work_memory: identity.work_memory,
            firmware: identity.firmware,
            build: identity.build,
            board: identity.board,
        }
    }

    /// Answers what only asks.
    pub(super) fn query(
        &mut self,
        header: Header,
        request: &Request<'_>,
        dropped: &Dropped,
        seen: &Seen,
    ) {
        let which = match *request {
            Request::Status {} => return self.answer(header, &self.status(seen)),
            Request::Link {} => return self.answer(header, &self.link(dropped)),
            Request::ParameterAt { index } => Which::At(index),
            Request::Parameter { name } => Which::Named(name),
            _ => return self.answer(header, &Self::reply(seen, Err(Refusal::NotUnderstood))),
        };
        let reply = parameter(&mut self.params, which);
        let reply = reply.unwrap_or_else(|refusal| Self::reply(seen, Err(refusal)));
        self.answer(header, &reply);
    }

    fn status(&self, seen: &Seen) -> Reply<'static> {
        let holder = self.lease.holder();
        let flags = [
            (seen.enabled, ENABLED),
            (seen.moving, MOVING),
            (seen.origin.is_some(), HOMED),
            (self.mover.is_held(), HELD),
            (holder.is_some(), LEASED),
            (holder == Some(self.session.number()), LEASED_HERE),
            (seen.is_planned, PLANNED),
        ];
        let flags = flags
            .into_iter()
            .filter(|(is_set, _)| *is_set)
            .fold(0, |sum, (_, bit)| sum | bit);
        let origin = seen.origin.unwrap_or_default();
        let error = crate::units::Position::from_bits(i64::from(seen.following_error));
        Reply::Status {
            tick: seen.tick,
            state: seen.state as u8,
            fault: seen.fault.map_or(0, |fault| fault as u8),
            warnings: seen.warnings,
            flags,
            percent: self.mover.percent(),
            position_nm: self.mover.nm(seen.reported),
            setpoint_nm: self.mover.nm(seen.commanded.saturating_sub(origin)),
            velocity_um_per_min: self.mover.um_per_min(seen.velocity),
            following_error_nm: self
                .mover
                .nm(error)
                .clamp(i64::from(i32::MIN), i64::from(i32::MAX))
                as i32,
        }
    }

    const fn link(&self, dropped: &Dropped) -> Reply<'static> {
        Reply::Link {
            torn: dropped.torn,
            too_long: dropped.too_long,
            too_short: dropped.too_short,
            checksum: dropped.checksum,
            unknown: dropped.unknown,
            late: dropped.late,
            records_lost: self.records_lost,
        }
    }

    /// Does what a request asks for, once.
    pub(super) fn carry_out(
        &mut self,
        request: &Request<'_>,
        seen: &Seen,
        port: &mut dyn Port,
    ) -> Result<(), Refusal> {
        let session = self.session.number();
        let leased = if request.needs_lease() {
            self.lease.check(session)
        } else {
            Ok(())
        };
        let outcome = leased.and_then(|()| self.try_to(request, seen, port));
        self.remember(outcome)
    }

    fn try_to(
        &mut self,
        request: &Request<'_>,
        seen: &Seen,
        port: &mut dyn Port,
    ) -> Result<(), Refusal> {
        let session = self.session.number();
        let axis = |port: &mut dyn Port, request| port.order(&Order::Axis(request));
        match *request {
            Request::TakeLease {} => self.lease.take(session, seen.tick),
            Request::RenewLease { seen: tick } => self.lease.renew(session, tick, seen.tick),
            Request::ReleaseLease {} if self.may_move(seen) => Err(Refusal::StillMoving),
            Request::ReleaseLease {} => self.lease.release(session),
            Request::Enable {} if seen.fault.is_some() => Err(Refusal::FaultLatched),
            Request::Enable {} if self.must_disable => Err(Refusal::QueueFull),
            Request::Enable {} => port.order(&Order::Enable(true)),
            Request::Disable {} => port.order(&Order::Enable(false)),
            Request::ClearFault {} => axis(port, axis::Request::ClearFault),
            Request::ClearWarnings {} => axis(port, axis::Request::ClearWarnings),
            Request::Home {} => axis(port, axis::Request::Home),
            Request::Move {
                target_nm,
                feed_um_per_min: feed_um,
            } => self.move_by(Motion::Move { target_nm, feed_um }, seen, port),
            Request::Jog {
                feed_um_per_min: feed_um,
            } => self.move_by(Motion::Jog { feed_um }, seen, port),
            Request::Hold {} => self.move_by(Motion::Hold, seen, port),
            Request::Resume {} => self.move_by(Motion::Resume, seen, port),
            Request::Override { percent } => self.move_by(Motion::Override { percent }, seen, port),
            Request::Stop {} if seen.is_planned => self.move_by(Motion::Stop, seen, port),
            Request::Stop {} => port.order(&Order::Enable(false)),
            Request::SetParameter { name, value } => self.set(name, value, seen, port),
            Request::Subscribe { every } => {
                self.every = every;
                self.until_record = 1;
                Ok(())
            }
            Request::Hello { .. }
            | Request::Status {}
            | Request::Link {}
            | Request::ParameterAt { .. }
            | Request::Parameter { .. } => Err(Refusal::NotUnderstood),
        }
    }

    /// True while a motion is under way, or may begin without another request.
    const fn may_move(&self, seen: &Seen) -> bool {
        let in_control = matches!(seen.state, State::Ready | State::Moving);
        seen.moving || self.mover.is_to_start() || in_control && !seen.is_planned
    }

    fn move_by(&mut self, motion: Motion, seen: &Seen, port: &mut dyn Port) -> Result<(), Refusal> {
        if seen.is_planned {
            return self.mover.order(motion, seen, port);
        }
        Err(match seen.state {
            State::Ready | State::Moving => Refusal::Busy,
            State::Stopping => Refusal::Stopping,
            State::Fault => Refusal::FaultLatched,
            State::Disabled | State::Enabling => Refusal::NotEnabled,
        })
    }

    fn set(
        &mut self,
        name: &str,
        value: f64,
        seen: &Seen,
        port: &mut dyn Port,
    ) -> Result<(), Refusal> {
        if seen.enabled || !matches!(seen.state, State::Disabled | State::Fault) {
            return Err(Refusal::AxisOn);
        }
        let which = Which::Named(name);
        let before = write(&mut self.params, which, value)?;
        let taken = self.params.validate();
        let taken = taken.map_err(|_| Refusal::Inconsistent);
        let taken = taken.and_then(|config| {
            port.reconfigure(&config)?;
            let feed = self.params.motion.max_feed_mm_per_min;
            self.mover.reconfigure(&config, feed);
            Ok(())
        });
        if taken.is_err() {
            let _ = write(&mut self.params, which, before);
        }
        taken
    }
}
