//! A part as its file describes it: features, where to touch them, with what probe.
//!
//! [`read`] reads that file, [`touches`] a table of touches, [`log`] a log of LinuxCNC; [`program`] writes the program that makes
//! such a log; [`evaluate`] computes the features.

pub mod evaluate;
mod expand;
mod file;
mod kinds;
pub mod log;
mod means;
mod others;
pub mod program;
pub mod report;
pub mod touches;

use leadscrew_nc::source::Complaint;

use super::Nominal;
use super::bore::Diameters;
use super::relations::TableTurn;
use super::touch::{Axis, Touch, vector3};

pub use file::read;

/// A part.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// In the order of the file.
    pub features: Vec<Feature>,
    /// The probe.
    pub probe: Probe,
    /// How tables of touches are meant.
    pub table: Table,
    /// How the probe moves.
    pub program: ProgramPlan,
}

/// What is known of the probe.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Probe {
    /// 1σ of a touch, mm, for all touches that state none.
    pub sigma_mm: Option<f64>,
    /// Radius of the stylus' ball, mm.
    pub radius_mm: f64,
    /// Travel from the first contact to the latch, mm.
    pub pretravel_mm: f64,
    /// The same where it differs by the direction of approach: along x, y, z, the − way first.
    pub pretravel_of: [[Option<f64>; 2]; 3],
}

impl Probe {
    /// The place on the surface of a touch with the centre of the ball at `centre` as latched: by the effective radius, less
    /// pre-travel, against the normal.
    #[must_use]
    pub fn surface(&self, centre: [f64; 3], normal: [f64; 3]) -> [f64; 3] {
        let effective = self.radius_mm - self.pretravel(normal);
        (vector3(centre) - vector3(normal).normalize() * effective).into()
    }

    fn pretravel(&self, normal: [f64; 3]) -> f64 {
        let own = Axis::along(normal).and_then(|axis| {
            // The probe comes against the normal.
            let plus = usize::from(normal[axis.index()] < 0.0);
            self.pretravel_of[axis.index()][plus]
        });
        own.unwrap_or(self.pretravel_mm)
    }
}

/// How tables of touches are meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Whether X is in diameters, as on lathes.
    pub x_is_diameter: bool,
    /// Whether places are those of the stylus' centre, to be compensated by its radius.
    pub is_of_stylus: bool,
}

/// How the probe moves, mm and mm/min.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramPlan {
    /// The axis along which the probe is free at [`Self::safe_mm`].
    pub safe_axis: Axis,
    /// Where; none if the file does not say.
    pub safe_mm: Option<f64>,
    /// From the start of a touch to the planned contact.
    pub approach_mm: f64,
    /// From the planned contact on, until the touch is given up.
    pub overtravel_mm: f64,
    /// Feed of the touch.
    pub feed_mm_per_min: f64,
    /// Feed between touches.
    pub travel_mm_per_min: f64,
    /// The file that the control writes.
    pub log: String,
}

/// A feature.
#[derive(Clone, Debug, PartialEq)]
pub struct Feature {
    /// Its name, not that of another.
    pub name: String,
    /// What it is.
    pub kind: Kind,
    /// Where it is to be touched, in order; empty if tables say so, or if nothing is touched.
    pub planned: Vec<Planned>,
    /// A complaint about it carries this.
    at: std::ops::Range<usize>,
}

impl Feature {
    /// Whether it is touched itself, not computed from others.
    #[must_use]
    pub const fn is_touched(&self) -> bool {
        self.kind.is_touched()
    }

    /// A complaint about it.
    pub fn complain(&self, text: &str, message: impl std::fmt::Display) -> Complaint {
        Complaint::at(text, &self.at, format!("{}: {message}", self.name))
    }
}

/// A planned touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// Its name within the feature.
    pub point: String,
    /// Place on the surface, mm.
    pub nominal: [f64; 3],
    /// Out of the material.
    pub normal: [f64; 3],
}

/// What a feature is. Others are named by their index.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A face.
    Plane,
    /// A line of a face.
    Shoulder {
        /// Along this axis.
        along: Axis,
    },
    /// A hole or a boss in one section.
    Circle {
        /// As planned.
        nominal: Nominal,
        /// Whether it is a hole.
        inside: bool,
    },
    /// The axis of a hole or a boss.
    Axis {
        /// As planned.
        nominal: Nominal,
        /// Whether it is a hole.
        inside: bool,
        /// What is taken of its diameters.
        diameters: Diameters,
    },
    /// A turned surface around z.
    Turned {
        /// As planned.
        nominal: Nominal,
        /// Whether it is bored.
        inside: bool,
    },
    /// Two circles.
    Coaxiality {
        /// Hole I and hole II.
        of: [usize; 2],
        /// The turn of the table between.
        turn: Option<TableTurn>,
    },
    /// Distance of two circles.
    Distance {
        /// The circles.
        of: [usize; 2],
    },
    /// An axis against a face.
    Perpendicularity {
        /// The axis.
        axis: usize,
        /// The face.
        face: usize,
    },
    /// A tool at its setter.
    Tool(ToolPlan),
    /// Number of passes.
    Passes(PassesPlan),
    /// The whole workpiece.
    Setting {
        /// Touched features.
        of: Vec<usize>,
        /// Which components are sought.
        free: [bool; 6],
    },
}

impl Kind {
    /// Whether it is touched itself, not computed from others.
    #[must_use]
    pub const fn is_touched(&self) -> bool {
        matches!(
            self,
            Self::Plane
                | Self::Shoulder { .. }
                | Self::Circle { .. }
                | Self::Axis { .. }
                | Self::Turned { .. }
        )
    }
}

/// A tool at its setter; all mm.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolPlan {
    /// Coordinate of the setter's surface.
    pub setter_mm: f64,
    /// Coordinates of the tool's control point at touches.
    pub touched_mm: Vec<f64>,
    /// 1σ of a touch.
    pub sigma_mm: Option<f64>,
    /// An earlier setting and its 1σ, for wear.
    pub then: Option<(f64, Option<f64>)>,
}

/// What is to be cut; all mm, at turned parts diameters.
#[derive(Clone, Debug, PartialEq)]
pub struct PassesPlan {
    /// The blank.
    pub blank: Blank,
    /// The coordinate or the diameter that is wanted.
    pub finished_mm: f64,
    /// Largest depth of a pass, across the surface.
    pub max_depth_mm: f64,
    /// Depth of the finishing pass, across the surface.
    pub finishing_mm: f64,
}

/// How large the blank is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blank {
    /// Stated: a coordinate, mm.
    Stated(f64),
    /// The touches of a face or a turned surface: those that stand out most.
    Of(usize),
}

/// Touches of a part: for every feature its touches with the names of their points.
pub type Touches = Vec<Vec<(String, Touch)>>;

/// An approach as `-z` or as three numbers, to the normal of the surface.
pub(super) fn normal_of_approach(approach: &str) -> Option<[f64; 3]> {
    direction(approach).map(|approach| approach.map(|part| 0.0 - part))
}

/// `+x`, `-z` or three numbers, of length 1.
pub(super) fn direction(text: &str) -> Option<[f64; 3]> {
    let text = text.trim();
    for axis in Axis::ALL {
        let letter = axis.name();
        if let Some(sign) = text.to_lowercase().strip_suffix(letter) {
            return match sign {
                "+" | "" => Some(axis.unit()),
                "-" => Some(axis.unit().map(|part| 0.0 - part)),
                _ => None,
            };
        }
    }
    let parts: Option<Vec<f64>> = text
        .split_whitespace()
        .map(|part| part.parse().ok())
        .collect();
    let parts: [f64; 3] = parts?.try_into().ok()?;
    let length = vector3(parts).norm();
    let known = length.is_finite() && length > 1e-6;
    known.then(|| (vector3(parts) / length).into())
}
