//! Line charts of time series, and drawings in planes, as SVG or PNG.
//!
//! A [`Figure`] is a stack of [`Panel`]s that share one time axis; a panel holds
//! [`Series`], drawn in their order, so noise goes first and the truth last.
//! kuva draws axes, ticks and text and encodes the image. Decimation, clipping,
//! dashes, the legend and the common margins are ours: they are what a long noisy
//! record of a control loop needs and a general chart does not.
//!
//! The same figure gives the same bytes every time and needs no font of the machine:
//! PNG text is set in the font inside kuva; SVG text names its fonts, since one inside
//! would cost a megabyte.

mod axis;
mod decimate;
mod draw;
mod error;
mod legend;
mod plane;
mod raster;
mod scene;
mod series;
mod stroke;
mod text;

use std::io::Write;
use std::path::Path;

use kuva::backend::svg::SvgBackend;

pub use decimate::decimate;
pub use error::PlotError;
pub use plane::{Plane, PlaneFigure};
pub use series::{Colour, Series, Stroke};

use crate::whole_file;
use draw::Target;

/// Width of a figure unless stated, pixels.
pub const DEFAULT_WIDTH: u32 = 1200;
/// Height given to each panel unless stated, pixels.
pub const DEFAULT_PANEL_HEIGHT: u32 = 350;
/// Least width of a figure, pixels: below it labels have no room.
pub const MIN_WIDTH: u32 = 400;
/// Least height of a figure for each panel, pixels.
pub const MIN_PANEL_HEIGHT: u32 = 160;
/// Greatest width and height of a figure, pixels: bounds the memory of a PNG.
pub const MAX_SIDE: u32 = 8192;

/// Panels stacked from top to bottom above one shared x axis.
#[derive(Debug, Clone)]
pub struct Figure {
    /// Line above the panels; empty for none.
    pub title: String,
    /// Panels from the top; at least one.
    pub panels: Vec<Panel>,
    /// Width of the image, pixels: [`MIN_WIDTH`] to [`MAX_SIDE`].
    pub width: u32,
    /// Height of the whole image, pixels: [`MIN_PANEL_HEIGHT`] for each panel to [`MAX_SIDE`].
    pub height: u32,
}

/// One chart of a figure.
#[derive(Debug, Clone, Default)]
pub struct Panel {
    /// Name and unit of the shared axis. Drawn once, under the bottom panel: the
    /// lowest panel with a non-empty label gives it.
    pub x_label: String,
    /// Name and unit of the vertical axis.
    pub y_label: String,
    /// Curves in drawing order: later ones cover earlier ones.
    pub series: Vec<Series>,
    /// Lower and upper end of the vertical axis; `None` fits the data. Curves are
    /// cut at the ends.
    pub y_limits: Option<(f64, f64)>,
}

impl Panel {
    /// A panel that fits its data.
    #[must_use]
    pub fn new(
        x_label: impl Into<String>,
        y_label: impl Into<String>,
        series: Vec<Series>,
    ) -> Self {
        Self {
            x_label: x_label.into(),
            y_label: y_label.into(),
            series,
            y_limits: None,
        }
    }

    /// The same panel with a fixed vertical axis.
    #[must_use]
    pub fn with_y_limits(mut self, low: f64, high: f64) -> Self {
        self.y_limits = Some((low, high));
        self
    }
}

impl Figure {
    /// A figure [`DEFAULT_WIDTH`] wide with [`DEFAULT_PANEL_HEIGHT`] for each panel.
    #[must_use]
    pub fn new(title: impl Into<String>, panels: Vec<Panel>) -> Self {
        let count = u32::try_from(panels.len()).unwrap_or(u32::MAX);
        Self {
            title: title.into(),
            panels,
            width: DEFAULT_WIDTH,
            height: DEFAULT_PANEL_HEIGHT.saturating_mul(count),
        }
    }

    /// Writes the figure in the format of the extension, `.svg` or `.png` in any case.
    ///
    /// The file appears whole or not at all: it is written beside its place and
    /// renamed. The directory must exist; a file of that name is replaced.
    ///
    /// # Errors
    /// Another extension, a figure that cannot be laid out (see [`PlotError`]), or
    /// the file system refusing.
    pub fn save(&self, path: &Path) -> Result<(), PlotError> {
        save_as(path, || self.to_svg(), || self.to_png())
    }

    /// The figure as an SVG document.
    ///
    /// # Errors
    /// As [`save`](Self::save), without those of the file.
    pub fn to_svg(&self) -> Result<String, PlotError> {
        let scene = scene::compose(self, Target::Svg)?;
        let document = SvgBackend::new().render_scene(&scene);
        // kuva gives a size but no view box; without one a browser crops a scaled picture.
        let view_box = format!(r#"<svg viewBox="0 0 {} {}" "#, self.width, self.height);
        Ok(document.replacen("<svg ", &view_box, 1))
    }

    /// The figure as a PNG file of exactly `width` × `height` pixels.
    ///
    /// # Errors
    /// As [`save`](Self::save), without those of the file.
    pub fn to_png(&self) -> Result<Vec<u8>, PlotError> {
        let scene = scene::compose(self, Target::Png)?;
        raster::render(&scene, self.width, self.height).map_err(PlotError::Encode)
    }

    fn validate(&self) -> Result<(), PlotError> {
        let count = u32::try_from(self.panels.len()).unwrap_or(u32::MAX);
        if count == 0 {
            return Err(PlotError::NoPanels);
        }
        let min_height = MIN_PANEL_HEIGHT.saturating_mul(count);
        let fits = (MIN_WIDTH..=MAX_SIDE).contains(&self.width)
            && (min_height..=MAX_SIDE).contains(&self.height);
        if !fits {
            return Err(PlotError::Size {
                width: self.width,
                height: self.height,
                min_height,
            });
        }
        for panel in &self.panels {
            if let Some((low, high)) = panel.y_limits
                && !(axis::is_drawable(low) && axis::is_drawable(high) && low < high)
            {
                return Err(PlotError::Limits {
                    panel: panel.y_label.clone(),
                    low,
                    high,
                });
            }
        }
        Ok(())
    }
}

/// Writes a figure in the format of the extension.
fn save_as(
    path: &Path,
    to_svg: impl FnOnce() -> Result<String, PlotError>,
    to_png: impl FnOnce() -> Result<Vec<u8>, PlotError>,
) -> Result<(), PlotError> {
    let extension = path.extension().and_then(|extension| extension.to_str());
    let bytes = match extension.map(str::to_ascii_lowercase).as_deref() {
        Some("svg") => to_svg()?.into_bytes(),
        Some("png") => to_png()?,
        _ => return Err(PlotError::Extension { path: path.into() }),
    };
    whole_file::write(path, |file| file.write_all(&bytes)).map_err(|cause| PlotError::Write {
        path: path.into(),
        cause,
    })
}
