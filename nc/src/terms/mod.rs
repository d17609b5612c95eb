//! What is added to a programmed place: named terms, summed into one correction K.
//!
//! K = −Δ, where Δ is measured less planned coordinate: a term states what the machine, the tool or the workpiece does wrong,
//! and K undoes it.

pub mod affine;
mod error;
pub mod grid;
pub mod screw;
mod table;
pub mod thermal;
pub mod watch;
pub mod wear;
pub mod workpiece;

use std::fmt::Debug;

pub use error::{TermError, Trouble};

use crate::coordinates::{AXES, Axis, AxisSet, Coordinates};

/// What rounding of a sum brings about and no program, mm or degrees: so far beyond the ends of a table its end still counts, and
/// an axis that goes by less stands still.
pub(crate) const ROUNDING: f64 = 1e-6;

/// A value within a table's range, rounding put right; none beyond it, or where it is no number.
fn in_range(value: f64, (first, last): (f64, f64)) -> Option<f64> {
    (first - ROUNDING..=last + ROUNDING)
        .contains(&value)
        .then(|| value.max(first).min(last))
}

/// Which way an axis came to where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Towards larger coordinates.
    Up,
    /// Towards smaller coordinates.
    Down,
}

/// For each axis the direction of its last movement; none before it has moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Approach([Option<Direction>; AXES]);

impl Approach {
    /// Nothing has moved yet.
    pub const UNKNOWN: Self = Self([None; AXES]);

    /// The direction of an axis.
    #[must_use]
    pub fn of(&self, axis: Axis) -> Option<Direction> {
        self.0[axis.index()]
    }

    /// With the direction of one axis set.
    #[must_use]
    pub fn with(mut self, axis: Axis, direction: Direction) -> Self {
        self.0[axis.index()] = Some(direction);
        self
    }

    /// After a movement by a difference: axes that did not move keep their direction.
    #[must_use]
    pub fn after(mut self, by: &Coordinates) -> Self {
        for (axis, difference) in by.iter() {
            if difference > ROUNDING {
                self = self.with(axis, Direction::Up);
            } else if difference < -ROUNDING {
                self = self.with(axis, Direction::Down);
            }
        }
        self
    }
}

/// What a correction may depend on besides the place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Circumstances {
    /// Number of the tool in use; none where unknown.
    pub tool: Option<u32>,
    /// Place of the control point less place of the tool's tip, as the offset in force makes the control move (0 with no
    /// tool offset in force); none where unknown.
    pub tool_offset: Option<Coordinates>,
    /// From where each axis came.
    pub approach: Approach,
}

/// How K depends on the place; what a line and an arc become follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shape {
    /// K = 0 everywhere.
    None,
    /// The same K everywhere: a line stays a line and an arc an arc. It may change with the tool.
    Constant,
    /// K = K0 + A·Y: a line stays a line.
    Affine,
    /// Anything else: lines may have to be split.
    Curved,
}

/// A box of places: a path lies within it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Lowest coordinates.
    pub low: Coordinates,
    /// Highest coordinates.
    pub high: Coordinates,
}

impl Region {
    /// The smallest box around two places.
    #[must_use]
    pub fn around(one: &Coordinates, other: &Coordinates) -> Self {
        let pick = |of: fn(f64, f64) -> f64| {
            one.iter()
                .map(|(axis, value)| (axis, of(value, other[axis])))
                .collect()
        };
        Self {
            low: pick(f64::min),
            high: pick(f64::max),
        }
    }

    /// Largest distance of its places from a coordinate.
    #[must_use]
    pub fn farthest_from(&self, axis: Axis, datum: f64) -> f64 {
        (self.low[axis] - datum)
            .abs()
            .max((self.high[axis] - datum).abs())
    }
}

/// Bounds on how fast K changes with the place, for chord errors. K is taken as the length of the vector of all corrected
/// axes, the way as that over all axes, mm and degrees alike.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Steepness {
    /// Largest |dK/ds| along any direction.
    pub slope: f64,
    /// Largest |d²K/ds²| along any straight way between breaks, per mm.
    pub bend: f64,
}

/// One cause of deviations. Along a straight line K is a polynomial of at most third degree between the breaks: on that the
/// bound of [`crate::path`] rests.
pub trait Term: Debug + Send + Sync {
    /// What messages and reports call it.
    fn name(&self) -> &str;

    /// K at a place of the control point in machine coordinates.
    ///
    /// # Errors
    /// Where the place lies outside of a table, or what the term needs to know is unknown.
    fn correction(&self, at: &Coordinates, with: &Circumstances) -> Result<Coordinates, TermError>;

    /// Axes it can correct.
    fn corrects(&self) -> AxisSet;

    /// Axes on whose place it depends.
    fn depends_on(&self) -> AxisSet;

    /// Axes on whose direction of approach it depends.
    fn depends_on_approach_of(&self) -> AxisSet {
        AxisSet::NONE
    }

    /// True where it depends on the tool or its offset.
    fn depends_on_tool(&self) -> bool {
        false
    }

    /// How K depends on the place.
    fn shape(&self) -> Shape;

    /// Hands on the places of an axis between which K is smooth, machine coordinates, in any order.
    fn breaks(&self, _axis: Axis, _found: &mut dyn FnMut(&[f64])) {}

    /// How fast K changes within a region.
    fn steepness(&self, within: &Region) -> Steepness;
}

/// Named terms, summed.
#[derive(Debug)]
pub struct Terms {
    list: Vec<Box<dyn Term>>,
    // What all of them do together, asked for at every block.
    corrects: AxisSet,
    depends_on: AxisSet,
    depends_on_approach_of: AxisSet,
    shape: Shape,
}

impl Default for Terms {
    fn default() -> Self {
        Self::none()
    }
}

impl Terms {
    /// No correction: K = 0 everywhere.
    #[must_use]
    pub const fn none() -> Self {
        Self {
            list: Vec::new(),
            corrects: AxisSet::NONE,
            depends_on: AxisSet::NONE,
            depends_on_approach_of: AxisSet::NONE,
            shape: Shape::None,
        }
    }

    /// With one term more.
    #[must_use]
    pub fn with(mut self, term: impl Term + 'static) -> Self {
        self.push(Box::new(term));
        self
    }

    /// Adds a term.
    pub fn push(&mut self, term: Box<dyn Term>) {
        self.corrects = self.corrects.union(term.corrects());
        self.depends_on = self.depends_on.union(term.depends_on());
        self.depends_on_approach_of = self
            .depends_on_approach_of
            .union(term.depends_on_approach_of());
        self.shape = self.shape.max(term.shape());
        self.list.push(term);
    }

    /// Takes over the terms of another.
    pub fn append(&mut self, other: Self) {
        for term in other.list {
            self.push(term);
        }
    }

    /// K at a place of the tool's control point in machine coordinates: to be added to the programmed coordinates.
    ///
    /// # Errors
    /// As [`Term::correction`]: there is no extrapolation beyond a table.
    pub fn correction(
        &self,
        at: &Coordinates,
        with: &Circumstances,
    ) -> Result<Coordinates, TermError> {
        self.list.iter().try_fold(Coordinates::ZERO, |sum, term| {
            Ok(sum + term.correction(at, with)?)
        })
    }

    /// Every term's own K at a place, by name: for reports.
    ///
    /// # Errors
    /// As [`Terms::correction`].
    pub fn each<'a>(
        &'a self,
        at: &Coordinates,
        with: &Circumstances,
    ) -> Result<Vec<(&'a str, Coordinates)>, TermError> {
        self.list
            .iter()
            .map(|term| Ok((term.name(), term.correction(at, with)?)))
            .collect()
    }

    /// The terms.
    pub fn iter(&self) -> impl Iterator<Item = &dyn Term> {
        self.list.iter().map(AsRef::as_ref)
    }

    /// Axes that any term can correct: the words that may be changed or added.
    #[must_use]
    pub const fn corrects(&self) -> AxisSet {
        self.corrects
    }

    /// Axes on whose place any term depends: what must be known.
    #[must_use]
    pub const fn depends_on(&self) -> AxisSet {
        self.depends_on
    }

    /// Axes on whose direction of approach any term depends: there K jumps where the axis turns round.
    #[must_use]
    pub const fn depends_on_approach_of(&self) -> AxisSet {
        self.depends_on_approach_of
    }

    /// True where any term depends on the tool or its offset.
    #[must_use]
    pub fn depends_on_tool(&self) -> bool {
        self.iter().any(Term::depends_on_tool)
    }

    /// How the sum depends on the place.
    #[must_use]
    pub const fn shape(&self) -> Shape {
        self.shape
    }

    /// Hands on the places of an axis between which K is smooth, those of each term.
    pub fn breaks(&self, axis: Axis, found: &mut dyn FnMut(&[f64])) {
        for term in self.iter() {
            term.breaks(axis, found);
        }
    }

    /// How fast the sum changes within a region.
    #[must_use]
    pub fn steepness(&self, within: &Region) -> Steepness {
        self.iter()
            .map(|term| term.steepness(within))
            .fold(Steepness::default(), |sum, one| Steepness {
                slope: sum.slope + one.slope,
                bend: sum.bend + one.bend,
            })
    }
}
