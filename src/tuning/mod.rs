//! Tuning, outside the tick: from a model of the drive to the parameters of the loop, in `f64`.
//!
//! [`model`] is what is known of the drive, by identification or from its data sheet; [`placement`] puts
//! the poles of the loop where they are wanted.

pub mod model;
pub mod placement;
pub mod plant;

pub use model::DriveModel;
