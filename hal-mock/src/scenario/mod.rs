//! Runs that the host and the firmware share: what is commanded at which tick.

mod error;
mod move_and_back;
mod tuning;

pub use error::ScenarioError;
pub use move_and_back::{MoveAndBack, Script, Setup, Simulation, TimedMove};
pub use tuning::{BANDWIDTH_RAD_PER_S, observer_params, tuned_axis, tuned_estimator};
