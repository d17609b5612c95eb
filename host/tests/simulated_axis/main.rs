//! The firmware in this process, over its link.

mod bode;
mod instruments;
mod monitor;
mod recordings;
mod replays;
mod session;
#[path = "../support/tuned.rs"]
mod support;
mod troubles;
mod tuned;
