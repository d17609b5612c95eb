//! Learning an encoder: against what it is made of, and what is refused.

mod any_captures;
mod generator;
mod motion;
mod real;
mod refusals;
mod runs;
mod simulator;
mod truth;
