//! Planned moves and their evaluation: limits, arrival, duration, the queue.

mod evaluation;
mod follower;
mod moves;
mod oracle;
mod planner;
mod plans;
mod queue;
mod refusals;
#[path = "../support/seeded.rs"]
mod seeded;
mod stop;
mod travel;
