//! Tuning, outside the tick: from a model of the drive to the parameters of the loop, in `f64`.
//!
//! [`model`] is what is known of the drive, by identification or from its data sheet; [`placement`] puts
//! the poles of the loop where they are wanted; [`margins`] says how far from instability the loop then is, with the
//! estimator that is really in it; [`autotune`] searches for the fastest loop that keeps its margins on every
//! drive near the model, and [`check`] runs it on a model with all its imperfections before it is offered.

pub mod autotune;
pub mod check;
pub mod complex;
pub mod margins;
pub mod model;
pub mod placement;
pub mod plant;
pub mod sensing;

pub use model::DriveModel;
