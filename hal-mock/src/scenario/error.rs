//! Why a scenario cannot run.

use core::fmt;

use leadscrew::axis::Refused;
use leadscrew::params::ParamError;
use leadscrew::setpoint::planner::PlannerError;
use leadscrew::setpoint::profile::PlanError;
use leadscrew::setpoint::trajectory::QueueError;
use leadscrew::setpoint::travel::TravelError;
use leadscrew::tuning::autotune::AutotuneError;

/// Why a scenario cannot run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScenarioError {
    /// A parameter is out of range.
    Param(ParamError),
    /// The move cannot be planned.
    Plan(PlanError),
    /// The axis did not take a move.
    Queue(QueueError),
    /// The planner does not plan it.
    Planner(PlannerError),
    /// There are no such limits of travel.
    Travel(TravelError),
    /// The axis does not do it.
    Refused(Refused),
    /// Nothing that autotune could offer.
    Autotune(AutotuneError),
    /// There is no estimator of the name.
    NoSuchEstimator,
}

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Param(error) => error.fmt(f),
            Self::Plan(error) => error.fmt(f),
            Self::Queue(error) => error.fmt(f),
            Self::Planner(error) => error.fmt(f),
            Self::Travel(error) => error.fmt(f),
            Self::Refused(error) => error.fmt(f),
            Self::Autotune(error) => write!(f, "autotune: {error}"),
            Self::NoSuchEstimator => f.write_str("there is no estimator of that name"),
        }
    }
}

impl core::error::Error for ScenarioError {}

impl<E: Into<ParamError>> From<E> for ScenarioError {
    fn from(error: E) -> Self {
        Self::Param(error.into())
    }
}
