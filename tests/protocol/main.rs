//! The link: frames, sessions, the lease, and the whole chain from a tool's request to the axis on its machine and back.

mod any_bytes;
mod chain;
mod corpus;
mod decoder;
mod lapse;
mod line;
mod parameters;
mod refusals;
mod rig;
#[path = "../support/seeded.rs"]
mod seeded;
mod telemetry;
mod words;
