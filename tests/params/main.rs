//! Parameters in physical units: validation, and gains from a model of the drive.

mod pole_placement;
#[path = "../support/seeded.rs"]
mod seeded;
mod validation;
