//! The firmware in this process, over its link.

mod bode;
mod instruments;
mod monitor;
mod recordings;
mod replays;
mod session;
mod support;
mod troubles;
#[path = "../support/tuned.rs"]
mod tuned;
