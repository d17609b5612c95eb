//! The cross-check of the encoder by a tachogenerator, on the simulated machine and on anything.

#[path = "../support/seeded.rs"]
mod seeded;

mod any_inputs;
mod disagreements;
mod fit;
mod runs;
