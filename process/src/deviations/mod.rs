//! Positional deviations of a machine (P4 (5), its Figures 5 to 7): what the deviations of its units do to the place of the tool
//! on the workpiece.
//!
//! The machine is two chains of units from the bed, one to the workpiece and one to the tool. A unit moves along or about an axis
//! of the unit that carries it, and deviates there by its setting vector ω = (a, b, c, λ, β, γ), which follows its coordinate.
//! Reduced to the tip of the tool by W = [[I, −\[r\]×], [0, I]] and summed over its chain it displaces tool or workpiece by Υ;
//! Δ = Υ(tool) − Υ(workpiece), and the correction is K = −Δ.
//!
//! [`Machine::deviation`] is that sum for small angles; [`Machine::exact_deviation`] is the same with full rotations.

mod correction;
mod error;
mod exact;
mod file;
mod indicators;
mod law;
mod machine;
mod map;
mod unit;

pub use crate::setting_vector::{Component, SettingVector, reduction};
pub use correction::Correction;
pub use error::DeviationError;
pub use file::{BUILT_IN, Loaded, built_in, read};
pub use indicators::{Indicator, Measured, Readings, Stand};
pub use law::{Function, Law, Table, Wave};
pub use machine::{Chain, DriveErrors, Machine, Part};
pub use map::{Extreme, Map, MapPoint};
pub use unit::{Drive, Motion, Unit, direction_of};
