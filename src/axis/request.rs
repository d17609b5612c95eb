//! What may be asked of the axis between two ticks, as one value that a queue can carry.

use core::fmt;

use super::Axis;
use super::experiment::StartError;
use crate::homing::HomeRefused;
use crate::identification::program::Program;
use crate::probe::{ProbeOrder, ProbeRefused};
use crate::setpoint::plan::Plan;
use crate::setpoint::sources::{GearError, SelectError, Source};
use crate::setpoint::thread::{ThreadOrder, ThreadRefusal};
use crate::setpoint::trajectory::QueueError;
use crate::setpoint::travel::TravelLimits;
use crate::supervisor::ClearError;

/// A request.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Request {
    /// [`Axis::queue`].
    Queue {
        /// The plan.
        plan: Plan,
        /// Tick of its start.
        start: u32,
    },
    /// [`Axis::set_travel`].
    Travel(Option<TravelLimits>),
    /// [`Axis::home`].
    Home,
    /// [`Axis::select`].
    Select(Source),
    /// [`Axis::engage_gear`].
    Engage(bool),
    /// [`Axis::arm_thread`].
    ArmThread(ThreadOrder),
    /// [`Axis::start_experiment`].
    StartExperiment(Program),
    /// [`Axis::release_experiment`].
    ReleaseExperiment,
    /// [`Axis::clear_fault`].
    ClearFault,
    /// Forgets the warnings.
    ClearWarnings,
    /// [`Axis::probe_towards`].
    Probe(ProbeOrder),
}

/// Why a request was refused; the axis goes on as it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refused {
    /// A plan.
    Queue(QueueError),
    /// Homing.
    Home(HomeRefused),
    /// A source.
    Select(SelectError),
    /// The gear.
    Gear(GearError),
    /// A thread.
    Thread(ThreadRefusal),
    /// An experiment.
    Experiment(StartError),
    /// Clearing.
    Clear(ClearError),
    /// Probing.
    Probe(ProbeRefused),
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Queue(error) => error.fmt(f),
            Self::Home(error) => error.fmt(f),
            Self::Select(error) => error.fmt(f),
            Self::Gear(error) => error.fmt(f),
            Self::Thread(error) => error.fmt(f),
            Self::Experiment(error) => error.fmt(f),
            Self::Clear(error) => error.fmt(f),
            Self::Probe(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for Refused {}

impl Axis<'_> {
    /// Does what is asked.
    ///
    /// # Errors
    /// [`Refused`]; the axis then goes on as it was.
    pub fn take(&mut self, request: &Request) -> Result<(), Refused> {
        match request {
            Request::Queue { plan, start } => self.queue(plan, *start).map_err(Refused::Queue),
            Request::Travel(travel) => {
                self.set_travel(*travel);
                Ok(())
            }
            Request::Home => self.home().map_err(Refused::Home),
            Request::Select(source) => self.select(*source).map_err(Refused::Select),
            Request::Engage(engaged) => self.engage_gear(*engaged).map_err(Refused::Gear),
            Request::ArmThread(order) => {
                self.arm_thread(order).map(|_| ()).map_err(Refused::Thread)
            }
            Request::StartExperiment(program) => {
                self.start_experiment(program).map_err(Refused::Experiment)
            }
            Request::ReleaseExperiment => {
                self.release_experiment();
                Ok(())
            }
            Request::ClearFault => self.clear_fault().map_err(Refused::Clear),
            Request::ClearWarnings => {
                self.supervisor_mut().clear_warnings();
                Ok(())
            }
            Request::Probe(order) => {
                (self.probe_towards(order).map(|_| ())).map_err(Refused::Probe)
            }
        }
    }
}
