//! What the service sees of the axis, and how it asks for something.

use crate::axis::{self, Axis};
use crate::params::AxisConfig;
use crate::protocol::refusal::Refusal;
use crate::protocol::reply::Reply;
use crate::protocol::request::Request;
use crate::setpoint::sources::Source;
use crate::setpoint::thread::ThreadPhase;
use crate::setpoint::travel::TravelLimits;
use crate::settings::Settings;
use crate::supervisor::{Fault, State};
use crate::units::{Position, Velocity};

/// What the service knows of the axis, as the last tick left it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// The last tick.
    pub tick: u32,
    /// Where the supervisor stands.
    pub state: State,
    /// The drive is enabled.
    pub enabled: bool,
    /// A motion is commanded.
    pub moving: bool,
    /// The fault that is latched.
    pub fault: Option<Fault>,
    /// Bit n: the warning of number n.
    pub warnings: u32,
    /// Where it is told to be, before compensation, d.
    pub commanded: Position,
    /// Where it is for its users, d from the origin.
    pub reported: Position,
    /// Count of the encoder without wrap.
    pub count: i64,
    /// How fast it is, d/tick.
    pub velocity: Velocity,
    /// Setpoint less position, Q15.16 d.
    pub following_error: i32,
    /// The raw position of coordinate 0, if it is homed.
    pub origin: Option<Position>,
    /// Soft limits of travel in force.
    pub travel: Option<TravelLimits>,
    /// It follows its plans, or could: nothing else moves it.
    pub is_planned: bool,
    /// Plans that were dropped at their start; wraps.
    pub dropped_plans: u32,
}

impl Seen {
    /// What there is to see of `axis`.
    #[must_use]
    pub fn of(axis: &Axis<'_>) -> Self {
        let outputs = axis.outputs();
        let in_control = matches!(outputs.state, State::Ready | State::Moving);
        Self {
            tick: outputs.tick,
            state: outputs.state,
            enabled: outputs.enabled,
            moving: outputs.moving,
            fault: outputs.fault,
            warnings: outputs.warnings.bits(),
            commanded: axis.commanded().position,
            reported: outputs.reported,
            count: outputs.count,
            velocity: outputs.estimate.velocity,
            following_error: outputs.following_error.to_bits(),
            origin: axis.homing().origin(),
            travel: axis.travel(),
            is_planned: in_control
                && !axis.homing().is_active()
                && !axis.probe().is_active()
                && axis.source() == Source::Trajectory
                && axis.thread_phase() == ThreadPhase::Idle
                && axis.experiment().is_none(),
            dropped_plans: axis.dropped_plans(),
        }
    }
}

/// What the service asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "it lives for a moment, and there is no heap"
)]
pub enum Order {
    /// The axis is to be under control, or not.
    Enable(bool),
    /// A request to the axis.
    Axis(axis::Request),
}

/// Tells an order on its way from others; wraps.
pub type Ticket = u16;

/// How far an order is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passed {
    /// The axis took it.
    Taken,
    /// It is on its way; what comes of it is told to [`Service::settle`](super::Service::settle).
    OnItsWay(Ticket),
}

/// The way to the axis, and to what its board has besides.
pub trait Port {
    /// Passes an order on, to be seen by the next tick.
    ///
    /// # Errors
    /// A [`Refusal`], where the axis refuses it at once or there is no way on; nothing comes of it then.
    fn order(&mut self, order: &Order) -> Result<Passed, Refusal>;

    /// Gives the axis, which is off, a new configuration.
    ///
    /// # Errors
    /// A [`Refusal`]; the one before stays.
    fn reconfigure(&mut self, config: &AxisConfig) -> Result<Passed, Refusal>;

    /// Whether the board can follow an axis with `settings`; asked before they are taken, and before the axis is enabled.
    ///
    /// # Errors
    /// A [`Refusal`]; with [`Refusal::RestartNeeded`] they are taken, but the axis is not enabled before a restart.
    fn check(&self, settings: &Settings) -> Result<(), Refusal> {
        let _ = settings;
        Ok(())
    }

    /// Does what is not the axis's: store, work memory, scope, learning, counters. Who asks may do so, and the axis is off
    /// where that is asked for; `settings` are those in force. A reply other than an acknowledgement goes to `say`, of
    /// requests that only ask.
    ///
    /// # Errors
    /// A [`Refusal`]: without a board, for everything.
    fn serve(
        &mut self,
        request: &Request<'_>,
        settings: &Settings,
        say: &mut dyn FnMut(&Reply<'_>),
    ) -> Result<(), Refusal> {
        let _ = (request, settings, say);
        Err(Refusal::NotSupported)
    }
}
