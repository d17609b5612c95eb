//! From setpoint and estimate to the drive: the law, its continuity, the limits, and the whole step.

mod any_bits;
mod any_events;
mod axis;
mod continuity;
mod integral;
mod law;
mod law_oracle;
mod learning;
mod links;
mod output;
mod parts;
mod rest;
#[path = "../support/seeded.rs"]
mod seeded;
mod signals;
mod turning;
