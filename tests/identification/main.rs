//! Identification of simulated drives, through the axis.

mod coverage;
mod figures;
mod mapped;
mod refusals;
mod support;
