//! The axis as a unit on a Modbus line.

mod axis;
mod fake;
mod garbage;
mod lines;
mod map;
mod masters;
mod page;
mod parameters;
#[path = "../../../tests/support/seeded.rs"]
mod seeded;
mod terminal;
