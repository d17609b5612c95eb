//! What hole, boss, axis and turned part share: touches around an axis.

use nalgebra::{Vector2, Vector3};

use super::adjustment::{Adjusted, Model, adjust};
use super::error::MetrologyError;
use super::fitted::Settings;
use super::nominal::Nominal;
use super::touch::{Touch, vector3};

/// Directions nearer to one line than this are along it, rad.
const SAME_DIRECTION: f64 = 1e-6;
/// Heights nearer than this are one section, mm.
const SAME_SECTION: f64 = 1e-6;
/// A touch must look along the radius to this angle, rad.
const ALONG_RADIUS: f64 = 1e-3;

/// What is known of the radii.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Radii {
    /// One for all.
    Common,
    /// One for every section.
    OfSections,
    /// One at the face, and its growth along the axis.
    Tapered,
}

/// Unknowns: the centre along each direction that is seen, mm; with `tilts` its slope along the axis likewise; then deviations of
/// the radii, mm, and of half the taper.
pub(super) struct Round {
    nominal: Nominal,
    /// Directions across that the touches see: both, one, or none if all touches come from one side.
    pub seen: Vec<Vector2<f64>>,
    pub tilts: bool,
    pub radii: Radii,
    pub sections: Vec<f64>,
    first_order: bool,
}

impl Round {
    pub const WHAT: &'static str = "a round feature";

    /// The model for these touches. Touches from one side alone tell the radius if the axis is taken as planned.
    pub fn new(
        nominal: Nominal,
        touches: &[Touch],
        tilts: bool,
        radii: Radii,
        settings: &Settings,
    ) -> Result<Self, MetrologyError> {
        for (index, touch) in touches.iter().enumerate() {
            check_touch(&nominal, touch, index + 1)?;
        }
        let mut sections: Vec<f64> = Vec::new();
        for height in touches.iter().map(|touch| nominal.height(touch.nominal)) {
            if sections
                .iter()
                .all(|section| (section - height).abs() > SAME_SECTION)
            {
                sections.push(height);
            }
        }
        sections.sort_by(f64::total_cmp);
        let outward: Vec<_> = touches.iter().map(|touch| nominal.outward(touch)).collect();
        Ok(Self {
            seen: seen(&outward)?,
            tilts,
            radii,
            sections,
            first_order: settings.first_order,
            nominal,
        })
    }

    pub fn fit(&self, touches: &[Touch], settings: &Settings) -> Result<Adjusted, MetrologyError> {
        adjust(self, touches, settings)
    }

    /// Index of the first unknown that is a radius.
    pub fn first_radius(&self) -> usize {
        self.seen.len() * if self.tilts { 2 } else { 1 }
    }

    /// Vector across the axis of unknowns from `first` on, as a vector of the workpiece.
    pub fn across(&self, values: &[f64]) -> Vector3<f64> {
        let across: Vector2<f64> = self
            .seen
            .iter()
            .zip(values)
            .map(|(seen, value)| seen * *value)
            .sum();
        let [first, second] = self.nominal.across();
        vector3(first.unit()) * across[0] + vector3(second.unit()) * across[1]
    }

    /// Which coordinates of the workpiece the touches see across the axis.
    pub fn seen_axes(&self) -> [bool; 3] {
        let mut known = [false; 3];
        for (index, axis) in self.nominal.across().into_iter().enumerate() {
            known[axis.index()] = self.seen.iter().any(|seen| seen[index].abs() > 0.5);
        }
        known
    }

    fn section_of(&self, touch: &Touch) -> usize {
        let height = self.nominal.height(touch.nominal);
        let is_it = |section: &f64| (section - height).abs() <= SAME_SECTION;
        self.sections.iter().position(is_it).unwrap_or(0)
    }

    fn place(&self, touch: &Touch) -> f64 {
        self.nominal.height(if self.first_order {
            touch.nominal
        } else {
            touch.measured
        })
    }

    /// The axis across itself at a height, mm, and its slope.
    fn axis_at(&self, height: f64, unknowns: &[f64]) -> (Vector2<f64>, Vector2<f64>) {
        let sum = |values: &[f64]| {
            let parts = self.seen.iter().zip(values);
            parts
                .map(|(seen, value)| seen * *value)
                .sum::<Vector2<f64>>()
        };
        let slope = if self.tilts {
            sum(&unknowns[self.seen.len()..])
        } else {
            Vector2::zeros()
        };
        (sum(unknowns) + slope * height, slope)
    }

    /// From the axis as fitted to the place found, and its length square to the tilted axis.
    fn reach(&self, touch: &Touch, unknowns: &[f64]) -> (Vector2<f64>, f64) {
        let (centre, slope) = self.axis_at(self.place(touch), unknowns);
        let place = self.nominal.offset(touch.measured) - centre;
        // One direction alone, or the first order: along the planned direction.
        if self.first_order || self.seen.len() < 2 {
            let outward = self.nominal.outward(touch);
            return (outward, place.dot(&outward));
        }
        let along = place.dot(&slope);
        let square = place.norm_squared() - along * along / (1.0 + slope.norm_squared());
        (place.normalize(), square.max(0.0).sqrt())
    }

    fn radius_row(&self, touch: &Touch) -> Vec<f64> {
        match self.radii {
            Radii::Common => vec![1.0],
            Radii::OfSections => {
                let mut row = vec![0.0; self.sections.len()];
                row[self.section_of(touch)] = 1.0;
                row
            }
            Radii::Tapered => vec![1.0, self.place(touch)],
        }
    }
}

impl Model for Round {
    const WHAT: &'static str = Self::WHAT;

    fn unknowns(&self) -> usize {
        self.first_radius()
            + match self.radii {
                Radii::Common => 1,
                Radii::OfSections => self.sections.len(),
                Radii::Tapered => 2,
            }
    }

    fn misfit(&self, touch: &Touch, unknowns: &[f64]) -> f64 {
        let (_, found) = self.reach(touch, unknowns);
        let planned = self.nominal.diameter_mm / 2.0 + self.nominal.taper / 2.0 * self.place(touch);
        let radii = self.radius_row(touch);
        let deviation: f64 = radii
            .iter()
            .zip(&unknowns[self.first_radius()..])
            .map(|(part, unknown)| part * unknown)
            .sum();
        found - planned - deviation
    }

    fn row(&self, touch: &Touch, unknowns: &[f64]) -> Vec<f64> {
        let (outward, _) = self.reach(touch, unknowns);
        let centre: Vec<f64> = self.seen.iter().map(|seen| seen.dot(&outward)).collect();
        let height = self.place(touch);
        let tilt = centre
            .iter()
            .map(|part| part * height)
            .filter(|_| self.tilts);
        let mut row: Vec<f64> = centre.iter().copied().chain(tilt).collect();
        row.extend(self.radius_row(touch));
        row
    }

    fn why_degenerate(&self, _: &[f64]) -> String {
        let many = if self.tilts || self.radii == Radii::Tapered {
            ", or all in one section"
        } else {
            ""
        };
        format!("they lie too near to one another around the axis{many}")
    }
}

fn check_touch(nominal: &Nominal, touch: &Touch, number: usize) -> Result<(), MetrologyError> {
    let wrong = |reason: String| {
        Err(MetrologyError::Misplaced {
            what: Round::WHAT,
            touch: number,
            reason,
        })
    };
    let offset = nominal.offset(touch.nominal);
    if offset.norm().is_nan() || offset.norm() < 1e-9 {
        return wrong("its planned place is on the axis".to_owned());
    }
    let normal = vector3(touch.normal);
    let [first, second] = nominal.across().map(|axis| normal[axis.index()]);
    let across = Vector2::new(first, second);
    let outward = offset.normalize();
    if across.dot(&outward).abs() < (1.0 - ALONG_RADIUS * ALONG_RADIUS / 2.0) * normal.norm() {
        return wrong("the probe does not come along the radius".to_owned());
    }
    Ok(())
}

/// Directions that touches from these sides see.
fn seen(outward: &[Vector2<f64>]) -> Result<Vec<Vector2<f64>>, MetrologyError> {
    let Some(first) = outward.first() else {
        return Err(MetrologyError::TooFew {
            what: Round::WHAT,
            needed: 2,
            found: 0,
        });
    };
    let is_along = |other: &Vector2<f64>| first.perp(other).abs() < SAME_DIRECTION;
    if !outward.iter().all(is_along) {
        return Ok(vec![Vector2::x(), Vector2::y()]);
    }
    if outward.iter().all(|other| first.dot(other) > 0.0) {
        return Ok(Vec::new());
    }
    let axis = first.iamax();
    if first[axis].abs() < 1.0 - SAME_DIRECTION {
        return Err(MetrologyError::Misplaced {
            what: Round::WHAT,
            touch: 1,
            reason: "touches of one diameter alone must come along an axis".to_owned(),
        });
    }
    let mut along = Vector2::zeros();
    along[axis] = 1.0;
    Ok(vec![along])
}
