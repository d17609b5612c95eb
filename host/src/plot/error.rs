//! What can stop a figure from being drawn.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::{MAX_SIDE, MIN_WIDTH};

/// Why a figure was not written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PlotError {
    /// The file name ends in neither `.svg` nor `.png`.
    #[error("cannot tell the format of plot `{}`: end its name in .svg or .png", path.display())]
    Extension {
        /// The name given.
        path: PathBuf,
    },
    /// The figure has no panel.
    #[error("the figure has no panel: give it at least one")]
    NoPanels,
    /// Width or height outside the limits.
    #[error(
        "figure of {width} × {height} pixels: width must be {MIN_WIDTH} to {MAX_SIDE}, \
         height {min_height} to {MAX_SIDE} for its panels"
    )]
    Size {
        /// Width given, pixels.
        width: u32,
        /// Height given, pixels.
        height: u32,
        /// Least height for this number of panels, pixels.
        min_height: u32,
    },
    /// Limits of a vertical axis that are not finite or not in ascending order.
    #[error("limits {low} to {high} of axis `{panel}`: give two finite numbers, the lower first")]
    Limits {
        /// Label of the panel's vertical axis.
        panel: String,
        /// Lower limit given.
        low: f64,
        /// Upper limit given.
        high: f64,
    },
    /// The image could not be encoded.
    #[error("cannot encode the image: {0}")]
    Encode(String),
    /// The file could not be written.
    #[error(
        "cannot write plot `{}` ({cause}): check that its directory exists and may be written to",
        path.display()
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// What the file system said.
        cause: io::Error,
    },
}
