//! What the axis and its planner refuse, in the numbers of the link.

use super::Refusal;
use crate::axis::{ReconfigureError, Refused, StartError};
use crate::homing::HomeRefused;
use crate::probe::ProbeRefused;
use crate::setpoint::plan::PlanError;
use crate::setpoint::planner::PlannerError;
use crate::setpoint::sources::{GearError, SelectError};
use crate::setpoint::trajectory::QueueError;
use crate::supervisor::ClearError;

impl From<Refused> for Refusal {
    fn from(refused: Refused) -> Self {
        match refused {
            Refused::Queue(error) => error.into(),
            Refused::Home(HomeRefused::NotReady) => Self::NotReady,
            Refused::Home(HomeRefused::NoIndex) => Self::NoIndex,
            Refused::Clear(error) => error.into(),
            Refused::Gear(GearError::Disabled) => Self::NotEnabled,
            Refused::Gear(GearError::NotSelected) => Self::OtherSource,
            Refused::Select(SelectError::Moving) => Self::StillMoving,
            Refused::Select(SelectError::Engaged) => Self::Engaged,
            Refused::Experiment(error) => error.into(),
            Refused::Probe(error) => error.into(),
            // Threads and gears are not asked for over the link yet.
            Refused::Gear(_) | Refused::Thread(_) => Self::Busy,
        }
    }
}

impl From<ProbeRefused> for Refusal {
    fn from(error: ProbeRefused) -> Self {
        match error {
            ProbeRefused::NotReady => Self::NotEnabled,
            ProbeRefused::Moving => Self::StillMoving,
            ProbeRefused::NoWay => Self::NoWay,
            ProbeRefused::FeedOutOfRange => Self::FeedOutOfRange,
            ProbeRefused::Overtravel { .. } => Self::TooMuchOvertravel,
            ProbeRefused::BeyondTravel => Self::BeyondTravel,
        }
    }
}

impl From<QueueError> for Refusal {
    fn from(error: QueueError) -> Self {
        match error {
            QueueError::Late => Self::TooLate,
            QueueError::Busy => Self::Busy,
            QueueError::Disabled => Self::NotEnabled,
            QueueError::Stopping => Self::Stopping,
            QueueError::BeyondTravel => Self::BeyondTravel,
            QueueError::OtherSource => Self::OtherSource,
        }
    }
}

impl From<ClearError> for Refusal {
    fn from(error: ClearError) -> Self {
        match error {
            ClearError::EnableRequested => Self::EnableRequested,
            ClearError::Stopping => Self::Stopping,
            ClearError::Moving => Self::StillMoving,
            ClearError::CausePersists(_) => Self::CausePersists,
        }
    }
}

impl From<PlannerError> for Refusal {
    fn from(error: PlannerError) -> Self {
        match error {
            PlannerError::Plan(PlanError::TooFar) => Self::TargetOutOfRange,
            PlannerError::Plan(PlanError::TooLong) => Self::MoveTooLong,
            PlannerError::BeyondTravel { .. } => Self::BeyondTravel,
            PlannerError::Override { .. } => Self::OverrideOutOfRange,
            PlannerError::TooEarly { .. } => Self::Busy,
        }
    }
}

impl From<ReconfigureError> for Refusal {
    fn from(_: ReconfigureError) -> Self {
        Self::StillMoving
    }
}

impl From<StartError> for Refusal {
    fn from(error: StartError) -> Self {
        match error {
            StartError::NotReady => Self::NotEnabled,
            StartError::Moving => Self::StillMoving,
            StartError::NotAtRest => Self::NotAtRest,
            StartError::Running => Self::ExperimentRuns,
        }
    }
}
