//! Sources of setpoints other than planned moves: pulses, analog command, gearing, threads.

mod analog;
mod ratio;
#[path = "../support/seeded.rs"]
mod seeded;
mod step_dir;
mod thread;
