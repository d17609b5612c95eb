//! The firmware in this process, over its link.

mod instruments;
mod session;
mod troubles;
#[path = "../support/tuned.rs"]
mod tuned;
