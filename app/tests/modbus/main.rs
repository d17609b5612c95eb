//! The axis as a unit on a Modbus line.

mod axis;
mod fake;
#[path = "../store/flash.rs"]
#[expect(dead_code, reason = "the power is not cut here")]
mod flash;
mod garbage;
mod lines;
mod linked;
mod map;
mod masters;
mod page;
mod parameters;
#[path = "../../../tests/support/seeded.rs"]
mod seeded;
mod terminal;
