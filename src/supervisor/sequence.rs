//! The states of the axis and the ways between them.

use super::fault::Reaction;
use super::{Permit, State};

/// Times of the sequence, ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Times {
    /// Longest wait for a ready drive.
    pub ready_timeout: u32,
    /// The loop holds before the brake is released.
    pub hold: u32,
    /// From the release of the brake until the axis may move.
    pub brake_release: u32,
    /// The loop holds after the brake's signal to close.
    pub brake_delay: u32,
    /// Longest controlled stop.
    pub stop_timeout: u32,
    /// Enable is kept at 0 V.
    pub zero_volts: u32,
}

/// Where the sequence stands: a state of the axis, or a step within one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Phase {
    #[default]
    Disabled,
    /// Enabled at 0 V, until the drive is ready.
    AwaitingReady,
    /// The loop holds, the brake is on.
    Holding,
    /// The loop holds, the brake opens.
    Releasing,
    /// Under control.
    Running,
    /// In a controlled stop.
    Stopping,
    /// The loop holds, the brake closes.
    Braking,
    /// 0 V, the drive brakes by itself.
    ZeroVolts,
    /// 0 V, the brake closes.
    ZeroVoltsBraking,
    /// Off by a fault.
    Faulted,
}

/// What the sequence goes by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cue {
    pub enable: bool,
    pub ready: bool,
    pub moving: bool,
    pub faulted: bool,
}

/// The sequence of enabling and stopping.
#[derive(Clone, Debug, Default)]
pub(super) struct Sequence {
    phase: Phase,
    /// Ticks left of the phase.
    left: u32,
}

/// Ways that may lead on within a tick, each with a time of zero: through enabling, or through a stop.
const WAYS_A_TICK: usize = 5;

impl Sequence {
    pub const fn phase(&self) -> Phase {
        self.phase
    }

    pub const fn is_running(&self) -> bool {
        matches!(self.phase, Phase::Running)
    }

    pub const fn permit(&self) -> Permit {
        match self.phase {
            Phase::Disabled | Phase::Faulted => Permit::Off,
            Phase::AwaitingReady | Phase::ZeroVolts | Phase::ZeroVoltsBraking => Permit::ZeroVolts,
            Phase::Holding | Phase::Releasing | Phase::Braking => Permit::Hold,
            Phase::Stopping => Permit::Stop,
            Phase::Running => Permit::Follow,
        }
    }

    #[cold]
    #[inline(never)]
    pub const fn state(&self, moving: bool, faulted: bool) -> State {
        match self.phase {
            Phase::Disabled => State::Disabled,
            Phase::AwaitingReady | Phase::Holding | Phase::Releasing => State::Enabling,
            Phase::Running if moving => State::Moving,
            Phase::Running => State::Ready,
            Phase::Stopping | Phase::Braking => State::Stopping,
            Phase::ZeroVolts | Phase::ZeroVoltsBraking if !faulted => State::Stopping,
            Phase::ZeroVolts | Phase::ZeroVoltsBraking | Phase::Faulted => State::Fault,
        }
    }

    /// The drive carries the axis at 0 V while the brake closes, so the brake is still open before.
    #[cold]
    #[inline(never)]
    pub const fn brake_released(&self) -> bool {
        matches!(
            self.phase,
            Phase::Releasing | Phase::Running | Phase::Stopping | Phase::ZeroVolts
        )
    }

    /// A tick of the phase has passed: before anything else in it.
    pub const fn count_down(&mut self) {
        self.left = self.left.saturating_sub(1);
    }

    /// Goes on as far as it may; true if the drive was awaited for too long.
    pub fn advance(&mut self, times: &Times, cue: Cue) -> bool {
        for _ in 0..WAYS_A_TICK {
            let before = self.phase;
            if self.go_on(times, cue) {
                return true;
            }
            if self.phase == before {
                break;
            }
        }
        false
    }

    /// One way at most.
    fn go_on(&mut self, times: &Times, cue: Cue) -> bool {
        let is_over = self.left == 0;
        match self.phase {
            Phase::Disabled if cue.enable => self.start_enabling(times),
            Phase::AwaitingReady if !cue.enable => self.give_up_enabling(),
            Phase::AwaitingReady if cue.ready => self.close_loop(times),
            Phase::AwaitingReady => return is_over,
            Phase::Holding | Phase::Releasing if !cue.enable => self.close_brake(times),
            Phase::Holding if is_over => self.release_brake(times),
            Phase::Releasing if is_over => self.take_control(),
            Phase::Running if !cue.enable => self.begin_stop(times),
            Phase::Stopping if !cue.moving => self.close_brake(times),
            Phase::Stopping if is_over => self.cut_to_zero(times),
            Phase::Braking if is_over => self.end_enable(cue.faulted),
            Phase::ZeroVolts if is_over => self.close_brake_at_zero(times),
            Phase::ZeroVoltsBraking if is_over => self.end_enable(cue.faulted),
            _ => {}
        }
        false
    }

    /// Does what a fault asks for; a stop that is under way is never weakened.
    pub fn react(&mut self, reaction: Reaction, times: &Times) {
        match (reaction, self.phase) {
            (Reaction::Warning, _) | (_, Phase::Faulted) => {}
            (Reaction::Off, _) | (_, Phase::Disabled | Phase::AwaitingReady) => self.cut_off(),
            (Reaction::ControlledStop, Phase::Running | Phase::Holding | Phase::Releasing) => {
                self.begin_stop(times);
            }
            (Reaction::ZeroVolts, phase)
                if !matches!(phase, Phase::ZeroVolts | Phase::ZeroVoltsBraking) =>
            {
                self.cut_to_zero(times);
            }
            _ => {}
        }
    }

    /// Fault → Disabled; false if the axis is not off yet.
    pub fn clear(&mut self) -> bool {
        let is_off = matches!(self.phase, Phase::Faulted | Phase::Disabled);
        if is_off {
            self.enter(Phase::Disabled, 0);
        }
        is_off
    }

    /// Disabled → Enabling: enable on, 0 V.
    fn start_enabling(&mut self, times: &Times) {
        self.enter(Phase::AwaitingReady, times.ready_timeout);
    }

    /// Enabling → Disabled: enable was taken back before the drive was ready.
    fn give_up_enabling(&mut self) {
        self.enter(Phase::Disabled, 0);
    }

    /// Within Enabling: the drive is ready, the loop holds against the brake.
    fn close_loop(&mut self, times: &Times) {
        self.enter(Phase::Holding, times.hold);
    }

    /// Within Enabling: the loop has held for its time, the brake opens.
    fn release_brake(&mut self, times: &Times) {
        self.enter(Phase::Releasing, times.brake_release);
    }

    /// Enabling → Ready.
    fn take_control(&mut self) {
        self.enter(Phase::Running, 0);
    }

    /// Ready, Moving → Stopping: the controlled stop.
    fn begin_stop(&mut self, times: &Times) {
        self.enter(Phase::Stopping, times.stop_timeout);
    }

    /// Within Stopping: the setpoint stands, the brake closes while the loop holds.
    fn close_brake(&mut self, times: &Times) {
        self.enter(Phase::Braking, times.brake_delay);
    }

    /// Any → Fault, or within Stopping where the controlled stop takes too long: 0 V, enable kept.
    fn cut_to_zero(&mut self, times: &Times) {
        self.enter(Phase::ZeroVolts, times.zero_volts);
    }

    /// Within the same: the brake closes at 0 V.
    fn close_brake_at_zero(&mut self, times: &Times) {
        self.enter(Phase::ZeroVoltsBraking, times.brake_delay);
    }

    /// Stopping → Disabled, or → Fault if one is latched: enable off.
    fn end_enable(&mut self, faulted: bool) {
        let phase = if faulted {
            Phase::Faulted
        } else {
            Phase::Disabled
        };
        self.enter(phase, 0);
    }

    /// Any → Fault: enable off, brake on, at once.
    fn cut_off(&mut self) {
        self.enter(Phase::Faulted, 0);
    }

    fn enter(&mut self, phase: Phase, ticks: u32) {
        self.phase = phase;
        self.left = ticks;
    }
}
