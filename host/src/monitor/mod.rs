//! A screen in front of an axis: how it stands, a rolling chart, keys to move and stop it.
//!
//! [`State`] is what is shown, [`Keys`] what a key means, [`draw`] the screen of a state; none of them knows a terminal or an
//! axis. [`Session`] puts them on an axis, the command on a terminal.

mod chart;
mod keys;
mod screen;
mod session;
mod state;

pub use keys::{Key, Keys, Order};
pub use screen::draw;
pub use session::Session;
pub use state::{CHART_SIGNALS, Sample, State};
