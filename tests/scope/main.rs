//! The scope: what it records against what the axis gave, written down apart.

mod any;
mod interruptions;
mod model;
mod moves;
mod pre_trigger;
mod puppet;
#[path = "../support/seeded.rs"]
mod seeded;
mod setups;
mod stream;
mod table;
mod triggers;
