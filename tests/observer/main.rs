//! The observer: in closed loop, by response, against an oracle, at rest, and with a model that is wrong.

mod any;
mod closed_loop;
mod configuration;
mod evidence;
mod lags;
mod models;
mod oracle;
mod rest;
mod runs;
#[path = "../support/seeded.rs"]
mod seeded;
