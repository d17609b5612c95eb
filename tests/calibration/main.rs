//! Learning an encoder: against what it is made of, and what is refused.

mod generator;
mod real;
