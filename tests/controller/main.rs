//! From setpoint and estimate to the drive: the law, its continuity, the limits, and the whole step.

mod axis;
mod continuity;
mod integral;
mod law;
mod links;
mod output;
#[path = "../support/seeded.rs"]
mod seeded;
mod signals;
