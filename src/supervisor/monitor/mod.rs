//! What the supervisor watches, a file each: cheap while all is well.

pub mod against;
pub mod disabled;
pub mod encoder_loss;
pub mod following;
pub mod index;
pub mod leaky;
pub mod readback;
pub mod saturation;
pub mod speed;
pub mod travel;
