//! Compensation of the screw: the table, the limits kept, reversal, and how it comes into force.

mod axis;
mod carriage;
mod limits;
mod motion;
mod reversal;
#[path = "../support/seeded.rs"]
mod seeded;
mod table;
