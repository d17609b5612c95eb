//! Sources of setpoints other than planned moves: pulses, analog command, gearing, threads.

mod analog;
mod gearing;
mod master;
mod passes;
mod ratio;
mod requests;
#[path = "../support/seeded.rs"]
mod seeded;
mod step_dir;
mod thread;
mod thread_refusals;
mod thread_travel;
