//! Identification of simulated drives, through the axis.

mod coverage;
mod figures;
mod refusals;
mod support;
