//! What is done for each request.

use super::motion::Motion;
use super::{Done, Inner, Order, Passed, Port, Seen};
use crate::axis;
use crate::protocol::VERSION;
use crate::protocol::decoder::Dropped;
use crate::protocol::frame::Header;
use crate::protocol::parameters::{NewValue, Which, parameter};
use crate::protocol::refusal::Refusal;
use crate::protocol::reply::{
    ENABLED, HELD, HOMED, LEASED, LEASED_HERE, MOVING, PLANNED, Reply, UNSAVED,
};
use crate::protocol::request::Request;
use crate::setpoint::sources::Source;
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
        port: &mut dyn Port,
    ) {
        let which = match *request {
            Request::Status {} => return self.answer(header, &self.status(seen)),
            Request::Link {} => return self.answer(header, &self.link(dropped)),
            Request::ParameterAt { index } => Which::At(index),
            Request::Parameter { name } => Which::Named(name),
            _ => return self.pass(header, request, seen, port),
        };
        let settings = self.edit.as_mut().unwrap_or(&mut self.settings);
        let reply = parameter(settings, which);
        let reply = reply.unwrap_or_else(|refusal| Self::reply(seen, Err(refusal)));
        self.answer(header, &reply);
    }

    /// Passes a question on to the board.
    fn pass(&mut self, header: Header, request: &Request<'_>, seen: &Seen, port: &mut dyn Port) {
        let Self {
            settings, buffer, ..
        } = self;
        let mut is_said = false;
        let said = port.serve(request, settings, &mut |reply| {
            is_said = buffer.message(header, reply).is_ok();
        });
        if !is_said {
            // Nothing to say, or more than a frame holds.
            let refusal = said.err().unwrap_or(Refusal::NotSupported);
            self.answer(header, &Self::reply(seen, Err(refusal)));
        }
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
            (self.is_unsaved, UNSAVED),
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
    ) -> Result<Passed, Refusal> {
        if request.needs_lease() {
            self.lease.check(self.session.number())?;
        }
        let session = self.session.number();
        let axis = |port: &mut dyn Port, request| port.order(&Order::Axis(request));
        let taken = |done: Result<(), Refusal>| done.map(|()| Passed::Taken);
        match *request {
            Request::TakeLease {} => taken(self.lease.take(session, seen.tick)),
            Request::RenewLease { seen: tick } => taken(self.lease.renew(session, tick, seen.tick)),
            Request::ReleaseLease {} if self.may_move(seen) => Err(Refusal::StillMoving),
            Request::ReleaseLease {} => taken(self.lease.release(session)),
            Request::Enable {} => self.enable(seen, port),
            Request::Disable {} => port.order(&Order::Enable(false)),
            Request::ClearFault {} => axis(port, axis::Request::ClearFault),
            Request::ClearWarnings {} => axis(port, axis::Request::ClearWarnings),
            Request::Home {} => axis(port, axis::Request::Home),
            Request::Probe {
                target_nm,
                feed_um_per_min,
                retract_nm,
            } => {
                Self::check_planned(seen)?;
                let order = self
                    .mover
                    .probe_order(seen, target_nm, feed_um_per_min, retract_nm)?;
                axis(port, axis::Request::Probe(order))
            }
            Request::Select { source } => axis(port, axis::Request::Select(source_of(source)?)),
            Request::Engage { engaged } => axis(port, axis::Request::Engage(switch(engaged)?)),
            Request::Stop {} if !seen.is_planned => port.order(&Order::Enable(false)),
            Request::Subscribe { every } => {
                self.every = every;
                self.until_record = 1;
                Ok(Passed::Taken)
            }
            Request::SetParameter { name, value } => {
                self.set(name, NewValue::Number(value), seen, port)
            }
            Request::SetWord { name, word } => self.set(name, NewValue::Word(word), seen, port),
            Request::EditParameters {} => self.open_edit(seen),
            Request::TakeParameters {} => self.take_edit(seen, port),
            Request::DropParameters {} => self.drop_edit(),
            Request::Program { .. } | Request::Segment { .. } => taken(self.draft.add(request)),
            Request::StartExperiment { .. } => {
                let program = self.draft.program()?;
                self.serve(request, port)?;
                axis(port, axis::Request::StartExperiment(program))
            }
            Request::EndExperiment {} => axis(port, axis::Request::ReleaseExperiment),
            Request::SaveParameters {} => {
                Self::check_off(seen)?;
                let passed = self.serve(request, port)?;
                self.is_unsaved = false;
                Ok(passed)
            }
            Request::SaveBytes { .. }
            | Request::Erase { .. }
            | Request::TakeMap {}
            | Request::SaveMap {}
            | Request::Restart {} => {
                Self::check_off(seen)?;
                self.serve(request, port)
            }
            Request::EndRun {} if self.may_move(seen) => Err(Refusal::StillMoving),
            _ => match Motion::of(request) {
                Some(motion) => self.move_by(motion, seen, port),
                None => self.serve(request, port),
            },
        }
    }

    fn serve(&self, request: &Request<'_>, port: &mut dyn Port) -> Result<Passed, Refusal> {
        port.serve(request, &self.settings, &mut |_| {})?;
        Ok(Passed::Taken)
    }

    fn enable(&mut self, seen: &Seen, port: &mut dyn Port) -> Result<Passed, Refusal> {
        if seen.fault.is_some() {
            return Err(Refusal::FaultLatched);
        }
        if self.watch.must_disable() {
            return Err(Refusal::QueueFull);
        }
        if self.needs_restart() {
            return Err(Refusal::RestartNeeded);
        }
        port.check(&self.settings)?;
        self.edit = None;
        port.order(&Order::Enable(true))
    }

    /// True while a motion is under way, or may begin without another request.
    pub(super) const fn may_move(&self, seen: &Seen) -> bool {
        let in_control = matches!(seen.state, State::Ready | State::Moving);
        seen.moving || self.mover.is_to_start() || in_control && !seen.is_planned
    }

    fn move_by(
        &mut self,
        motion: Motion,
        seen: &Seen,
        port: &mut dyn Port,
    ) -> Result<Passed, Refusal> {
        Self::check_planned(seen)?;
        self.mover.order(motion, seen, port)
    }

    /// Whether plans may move the axis.
    const fn check_planned(seen: &Seen) -> Result<(), Refusal> {
        if seen.is_planned {
            return Ok(());
        }
        Err(match seen.state {
            State::Ready | State::Moving => Refusal::Busy,
            State::Stopping => Refusal::Stopping,
            State::Fault => Refusal::FaultLatched,
            State::Disabled | State::Enabling => Refusal::NotEnabled,
        })
    }
}

/// Off or on.
const fn switch(number: u8) -> Result<bool, Refusal> {
    match number {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(Refusal::NotSupported),
    }
}

/// The source of setpoints of that number.
const fn source_of(number: u8) -> Result<Source, Refusal> {
    match number {
        0 => Ok(Source::Trajectory),
        1 => Ok(Source::StepDir),
        2 => Ok(Source::Analog),
        3 => Ok(Source::Gearing),
        _ => Err(Refusal::NotSupported),
    }
}
