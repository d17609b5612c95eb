//! The process engineer's figures of machines, parts and encoders. On the host: all of it is f64.
//!
//! Lengths are mm, angles rad, unless a name says otherwise; a deviation is measured less planned *coordinate*, positive along
//! its axis, and an angle a right-handed rotation.
#![forbid(unsafe_code)]

pub mod axis_calibration;
pub mod deviations;
pub mod metrology;
pub mod plan;
pub mod probing;
pub mod prove_out;
pub mod setting_vector;
