//! The simulated machine does what its parameters say.

mod carriage;
mod couplings;
mod disc;
mod drive;
mod encoder_capture;
mod encoder_edges;
mod encoder_errors;
mod encoder_index;
mod faults;
mod friction;
mod motions;
mod scenes;
#[path = "../support/seeded.rs"]
mod seeded;
mod spindle;
mod statistics;
mod tachogenerator;
