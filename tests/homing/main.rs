//! Homing: on the simulated machine and on captures made up.

mod any;
mod failures;
mod kept;
mod repeatable;
mod rig;
#[path = "../support/seeded.rs"]
mod seeded;
