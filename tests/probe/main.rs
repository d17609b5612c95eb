//! Probing: on the simulated machine and on captures made up.

mod any;
mod figures;
mod follower;
mod latch;
mod moments;
