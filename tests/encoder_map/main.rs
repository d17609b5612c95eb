//! The encoder map: its image, its sums, its tie to the index, and what it does for the edges of the simulator.

mod any_captures;
mod axis;
mod content;
mod image;
mod refusals;
mod sums;
mod tie;
mod truth;

#[path = "../support/seeded.rs"]
mod seeded;
