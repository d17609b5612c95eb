//! One curve: its points and how it looks.

/// Width of a line unless stated, pixels.
const LINE_WIDTH: f64 = 1.8;
/// Diameter of a dot unless stated, pixels.
const DOT_DIAMETER: f64 = 2.0;
/// Widths outside are drawn as the nearer end.
const WIDTH_LIMITS: (f64, f64) = (0.5, 20.0);

/// Colours that readers with any colour vision tell apart: Okabe and Ito's palette,
/// and a grey for what stays in the background.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[expect(missing_docs, reason = "the names are the palette's own")]
pub enum Colour {
    #[default]
    Blue,
    Vermillion,
    BluishGreen,
    ReddishPurple,
    Orange,
    SkyBlue,
    /// Faint on white: for wide strokes only.
    Yellow,
    Black,
    /// Not of the palette: raw data beneath its estimates.
    Grey,
}

impl Colour {
    /// Colours for curves on white, in the order to use them.
    pub const CYCLE: [Self; 6] = [
        Self::Blue,
        Self::Vermillion,
        Self::BluishGreen,
        Self::ReddishPurple,
        Self::Orange,
        Self::SkyBlue,
    ];

    /// The colour of curve number `index`; repeats after [`CYCLE`](Self::CYCLE).
    #[must_use]
    pub const fn cycle(index: usize) -> Self {
        Self::CYCLE[index % Self::CYCLE.len()]
    }

    /// Red, green and blue, sRGB.
    #[must_use]
    pub const fn rgb(self) -> (u8, u8, u8) {
        match self {
            Self::Blue => (0, 114, 178),
            Self::Vermillion => (213, 94, 0),
            Self::BluishGreen => (0, 158, 115),
            Self::ReddishPurple => (204, 121, 167),
            Self::Orange => (230, 159, 0),
            Self::SkyBlue => (86, 180, 233),
            Self::Yellow => (240, 228, 66),
            Self::Black => (0, 0, 0),
            Self::Grey => (170, 170, 170),
        }
    }
}

/// How the points of a series are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Stroke {
    /// A continuous line.
    #[default]
    Solid,
    /// A broken line.
    Dashed,
    /// Points alone.
    Dots,
}

/// A curve over time.
///
/// Points are drawn by ascending x. A point with a value that is not finite is
/// skipped and leaves a gap in the line.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name in the legend; empty keeps the series out of it.
    pub name: String,
    /// Points (x, y) in the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// Colour of line or dots.
    pub colour: Colour,
    /// Line, dashes or dots.
    pub stroke: Stroke,
    /// Width of the line or diameter of the dots, pixels: 0.5 to 20.
    pub width: f64,
}

impl Default for Series {
    fn default() -> Self {
        Self::line("", Vec::new(), Colour::default())
    }
}

impl Series {
    /// A continuous line.
    #[must_use]
    pub fn line(name: impl Into<String>, points: Vec<(f64, f64)>, colour: Colour) -> Self {
        Self {
            name: name.into(),
            points,
            colour,
            stroke: Stroke::Solid,
            width: LINE_WIDTH,
        }
    }

    /// A broken line.
    #[must_use]
    pub fn dashed(name: impl Into<String>, points: Vec<(f64, f64)>, colour: Colour) -> Self {
        Self {
            stroke: Stroke::Dashed,
            ..Self::line(name, points, colour)
        }
    }

    /// Dots without a line.
    #[must_use]
    pub fn dots(name: impl Into<String>, points: Vec<(f64, f64)>, colour: Colour) -> Self {
        Self {
            stroke: Stroke::Dots,
            width: DOT_DIAMETER,
            ..Self::line(name, points, colour)
        }
    }

    /// The same series with another width of line or diameter of dots, pixels.
    #[must_use]
    pub fn with_width(mut self, pixels: f64) -> Self {
        self.width = pixels;
        self
    }

    /// The width to draw: the stated one within its limits.
    pub(super) fn drawn_width(&self) -> f64 {
        if self.width.is_nan() {
            return LINE_WIDTH;
        }
        self.width.clamp(WIDTH_LIMITS.0, WIDTH_LIMITS.1)
    }
}
