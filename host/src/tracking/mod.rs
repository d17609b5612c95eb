//! How well the axis follows: following error, standing error, limit cycle and creep on simulated machines.

pub mod ours;

pub use ours::{Course, Rig, TrackingFigures, model_of, tuned_on};
