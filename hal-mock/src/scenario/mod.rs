//! Runs that the host and the firmware share: what is commanded, and what goes wrong, at which tick.
//!
//! [`MoveAndBack`] is the standard run, a [`Scenario`] any other one. A scenario states in physical units what a file
//! of the host says or a constant of the firmware; a [`Runner`] steps its [`World`] and its axis.

pub mod action;
mod built_in;
mod definition;
mod desk;
mod error;
mod fate;
mod move_and_back;
mod operator;
mod plant;
mod runner;
mod sections;
mod tuning;
mod workshop;
mod world;

pub use action::{Action, Ask, EncoderTrouble, Interference, Outer, Pulse, Timed, Trouble};
pub use built_in::{BUILT_IN, built_in};
pub use definition::{Base, MAX_DURATION_S, Scenario, ScrewReading, Setting, Tuning, tick_at};
pub use desk::{Desk, LEAD_TICKS};
pub use error::ScenarioError;
pub use fate::Fate;
pub use move_and_back::{MoveAndBack, Script, Setup, Simulation, TimedMove};
pub use operator::{Operator, Order, Seen};
pub use plant::Plant;
pub use runner::{Happening, Runner};
pub use sections::{
    BOARD_SECTIONS, MACHINE_SECTIONS, Visitor, visit_axis, visit_machine, visit_plant,
};
pub use tuning::{
    BANDWIDTH_RAD_PER_S, autotuned_axis, model_of, observer_params, tuned_axis, tuned_estimator,
};
pub use workshop::workshop;
pub use world::World;
