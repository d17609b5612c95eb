//! `leadscrew calibrate-axis`: accuracy and repeatability of positioning of an axis after ISO 230-2, and the tables that undo
//! its errors.
//!
//! ```text
//! runs.csv ─► Runs ─► reduced to 20 °C ─► Calibration: x̄, s, B, R, E, M, A ─► uncertainty (k = 2)
//!             alias: targets at multiples of the pitch │
//!                                                      └─► ErrorTable ─► on-board screw table, LinuxCNC's COMP_FILE
//! ```
//!
//! A deviation is where the carriage is less where it was told to be, as everywhere here. Deviations and all that is computed
//! of them are µm, places mm, temperatures °C.

pub mod alias;
pub mod figures;
pub mod linuxcnc;
pub mod reduction;
pub mod runs;
pub mod table;
pub mod uncertainty;

pub use alias::Alias;
pub use figures::{AxisFigures, Calibration, TargetFigures, Unfit};
pub use reduction::Expansion;
pub use runs::{Direction, Reading, Runs};
pub use table::{ErrorPoint, ErrorTable};
pub use uncertainty::{Sources, Uncertainty};
