//! Moves from rest to rest by a distance: [`Profile`]s that start wherever the axis stands then.

pub use super::limits::Limits;
pub use super::plan::{MAX_TICKS, Plan as Profile, PlanError, STATE_FRAC};
