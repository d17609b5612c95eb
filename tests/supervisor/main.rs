//! The supervisor on the simulated machine: each fault from its documented condition, the sequence of enabling and
//! stopping, no false alarm, and any sequence of events.

mod any_events;
mod captures;
mod clearing;
mod controlled_stops;
mod false_alarms;
mod immediate;
mod page;
mod rig;
#[path = "../support/seeded.rs"]
mod seeded;
mod sequence;
