//! Metrology of a part on the machine: what touches of a probe say about it (P4).
//!
//! A [`Touch`] has a planned place, the way its surface looks and the place found. Deviations are measured less planned
//! coordinate, positive along the axis whichever way the surface looks; rotations λ, β, γ are right-handed about x, y, z, so a
//! rigid rotation of a perfect part turns all its features by the same angles.
//!
//! Features are fitted by least squares, weighted where a 1σ is stated, to all their touches. Without redundancy that gives P4's
//! formulas, which the tests hold against it.
//!
//! Reading order: [`touch`], [`fitted`], then a file a feature; [`part`] is what a user's files say, measured.

pub(crate) mod adjustment;
pub mod bore;
pub mod circle;
mod error;
pub mod fitted;
mod flat;
mod nominal;
mod outliers;
pub mod part;
pub mod passes;
pub mod plane;
pub mod relations;
mod round;
pub mod setting;
pub mod shoulder;
mod solve;
pub mod tool;
pub mod touch;

pub use error::MetrologyError;
pub use fitted::{Fitted, Settings, SigmaFrom};
pub use nominal::Nominal;
pub use touch::{Axis, Touch};
