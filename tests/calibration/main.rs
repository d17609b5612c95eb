//! Learning an encoder: against what it is made of, and what is refused.

mod generator;
mod real;
mod refusals;
mod runs;
mod truth;
