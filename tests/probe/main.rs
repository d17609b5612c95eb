//! Probing: on the simulated machine and on captures made up.

mod figures;
