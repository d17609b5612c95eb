//! The screw error table: what the carriage is off at points of the travel, for either direction.
//!
//! A table is built outside the tick, from what a laser shows, into memory that the caller lends. What the tick
//! needs of a stretch between two points is worked out there: its start, its length, and value and slope for either
//! direction, so that the tick neither divides nor searches.

use core::fmt;

use fixed::types::I12F20;

use super::Heading;
use crate::units::Position;

/// Error of the carriage, and its compensation, d.
pub type ScrewError = I12F20;

/// Points of a table.
pub const POINTS: (usize, usize) = (2, 256);
/// Largest error of a point, d.
pub const MAX_ERROR_D: f64 = 1000.0;
/// Steepest error that a table may hold, d a d: no screw has it, and the compensated position stays monotone.
pub const MAX_SLOPE: f64 = 0.1;
/// Longest way from one point to the next, d.
pub const MAX_SPACING_D: f64 = 8_388_607.0;

/// Shortest way from one point to the next, d: a unit of the offset.
pub const MIN_SPACING_D: f64 = 1.0 / 256.0;

/// Fractional bits of an offset within a stretch.
const OFFSET_FRAC: u32 = 8;
/// Fractional bits of a slope.
const SLOPE_FRAC: u32 = 31;

/// What was measured at a place of the travel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScrewPoint {
    /// The place in machine coordinates (from the origin), d.
    pub position: Position,
    /// Carriage less place, having come there towards larger and towards smaller positions, d.
    pub error: [ScrewError; 2],
}

/// A stretch between two points, as the tick needs it. Its fields are nobody's business but the table's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stretch {
    /// Where it begins, Q48.16 d.
    from: i64,
    /// How long it is, Q.8 d.
    length: i32,
    /// Forward, backward.
    lines: [Line; 2],
}

/// The compensation along a stretch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Line {
    /// At its start, Q12.20 d.
    value: i32,
    /// How it grows, Q.31 d a d.
    slope: i32,
}

/// A table in lent memory.
#[derive(Clone, Copy, Debug)]
pub struct ScrewTable<'m> {
    stretches: &'m [Stretch],
    steepest: Extreme,
    shortest: Extreme,
}

/// The largest or smallest of the stretches, and the number of the point where it begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// Number of the point, from 0.
    pub point: usize,
    /// Slope, d a d, or length, d.
    pub value: f64,
}

impl<'m> ScrewTable<'m> {
    /// Checks `points` and works the table out in `memory`, which takes one [`Stretch`] for each point but the
    /// last. Outside the tick.
    ///
    /// # Errors
    /// [`TableError`] naming the first point that is wrong.
    pub fn build(points: &[ScrewPoint], memory: &'m mut [Stretch]) -> Result<Self, TableError> {
        let count = points.len();
        if !(POINTS.0..=POINTS.1).contains(&count) {
            return Err(TableError::Points { count });
        }
        let needed = count.saturating_sub(1);
        let given = memory.len();
        let Some(stretches) = memory.get_mut(..needed) else {
            return Err(TableError::Memory { given, needed });
        };
        let mut steepest = Extreme {
            point: 0,
            value: 0.0,
        };
        let mut shortest = Extreme {
            point: 0,
            value: f64::INFINITY,
        };
        check_errors(0, points.first())?;
        let pairs = points.array_windows().zip(stretches.iter_mut());
        for (point, ([before, after], stretch)) in pairs.enumerate() {
            check_errors(point.wrapping_add(1), Some(after))?;
            let (made, slope, length) = Stretch::between(point, before, after)?;
            *stretch = made;
            if slope > steepest.value {
                steepest = Extreme {
                    point,
                    value: slope,
                };
            }
            if length < shortest.value {
                shortest = Extreme {
                    point,
                    value: length,
                };
            }
        }
        Ok(Self {
            stretches,
            steepest,
            shortest,
        })
    }

    /// Points of the table.
    #[must_use]
    pub const fn points(&self) -> usize {
        self.stretches.len().wrapping_add(1)
    }

    /// The steepest stretch, in either direction.
    #[must_use]
    pub const fn steepest(&self) -> Extreme {
        self.steepest
    }

    /// The shortest stretch.
    #[must_use]
    pub const fn shortest(&self) -> Extreme {
        self.shortest
    }

    /// Stretch number `stretch` as `heading` finds it, with the zero of machine coordinates at `origin` and `take_up`
    /// (Q12.20 d) on top.
    pub(super) fn here(
        &self,
        stretch: usize,
        heading: Heading,
        origin: i64,
        take_up: i32,
    ) -> Option<Here> {
        let stretch = self.stretches.get(stretch)?;
        let line = *heading.of_pair(&stretch.lines);
        Some(Here {
            from: stretch.from.wrapping_add(origin),
            length: stretch.length,
            line: Line {
                value: line.value.wrapping_add(take_up),
                ..line
            },
        })
    }

    /// Number of the stretch before or after another, or itself at the end of the table.
    pub(super) const fn neighbour(&self, stretch: usize, is_before: bool) -> usize {
        if is_before {
            return stretch.saturating_sub(1);
        }
        let after = stretch.saturating_add(1);
        if after < self.stretches.len() {
            after
        } else {
            stretch
        }
    }

    /// The stretch of a place, by search: outside the tick.
    pub(super) fn find(&self, place: i64) -> usize {
        let after = self
            .stretches
            .partition_point(|stretch| stretch.from <= place);
        after.saturating_sub(1)
    }
}

impl Stretch {
    /// A stretch of no length: what memory for a table begins as.
    pub const EMPTY: Self = Self {
        from: 0,
        length: 0,
        lines: [Line { value: 0, slope: 0 }; 2],
    };

    /// With its steepest slope and its length, d.
    fn between(
        point: usize,
        before: &ScrewPoint,
        after: &ScrewPoint,
    ) -> Result<(Self, f64, f64), TableError> {
        let next = point.saturating_add(1);
        let length = in_d(after.position) - in_d(before.position);
        if !(MIN_SPACING_D..=MAX_SPACING_D).contains(&length) {
            return Err(TableError::Spacing {
                point: next,
                spacing_d: length,
            });
        }
        let rise = |[from, to]: [ScrewError; 2]| to.to_num::<f64>() - from.to_num::<f64>();
        let [[forward, backward], [forward_after, backward_after]] = [before.error, after.error];
        let slopes =
            [[forward, forward_after], [backward, backward_after]].map(|ends| rise(ends) / length);
        let steepest = libm::fmax(slopes[0].abs(), slopes[1].abs());
        if steepest > MAX_SLOPE {
            return Err(TableError::Slope {
                point: next,
                slope: steepest,
            });
        }
        let line = |error: ScrewError, slope: f64| Line {
            value: error.to_bits().wrapping_neg(),
            slope: -libm::round(libm::ldexp(slope, SLOPE_FRAC.cast_signed())) as i32,
        };
        let from = before.position.to_bits();
        let end = after.position.to_bits();
        let stretch = Self {
            from,
            length: end.wrapping_sub(from).wrapping_shr(POSITION_TO_OFFSET) as i32,
            lines: [line(forward, slopes[0]), line(backward, slopes[1])],
        };
        Ok((stretch, steepest, length))
    }
}

/// A stretch as one heading finds it, in the raw positions of the setpoint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Here {
    /// Start, Q48.16 d.
    from: i64,
    /// Q.8 d.
    length: i32,
    line: Line,
}

impl Here {
    /// Compensation at `place`, Q12.20 d, if it lies within.
    #[inline]
    pub const fn value_within(&self, place: i64) -> Option<i32> {
        let offset = self.offset(place);
        // Below its start it is large without a sign.
        if offset.cast_unsigned() > self.length.cast_unsigned() as u64 {
            return None;
        }
        Some(self.value(offset as i32))
    }

    /// Compensation at `place`, or at the end that is nearer to it.
    pub fn value_at_nearest(&self, place: i64) -> i32 {
        let offset = self.offset(place).max(0).min(i64::from(self.length));
        self.value(offset as i32)
    }

    /// True if `place` lies below the start.
    pub const fn is_below(&self, place: i64) -> bool {
        self.offset(place) < 0
    }

    /// How far `place` lies beyond the start, Q.8 d.
    #[inline]
    const fn offset(&self, place: i64) -> i64 {
        place
            .wrapping_sub(self.from)
            .wrapping_shr(POSITION_TO_OFFSET)
    }

    /// Compensation at `offset` within the length: |slope| ≤ 0.1 over 2³¹ units adds at most 2²⁸·0.1·2³ in Q.20 and
    /// is bounded by the points' own values.
    #[inline]
    const fn value(&self, offset: i32) -> i32 {
        let Line { value, slope } = self.line;
        let rise = (offset as i64).wrapping_mul(slope as i64);
        value.wrapping_add(rise.wrapping_shr(RISE_SHIFT) as i32)
    }
}

const POSITION_TO_OFFSET: u32 = Position::FRAC_NBITS - OFFSET_FRAC;
const RISE_SHIFT: u32 = SLOPE_FRAC + OFFSET_FRAC - ScrewError::FRAC_NBITS;

fn check_errors(point: usize, checked: Option<&ScrewPoint>) -> Result<(), TableError> {
    let errors = checked.map_or([ScrewError::ZERO; 2], |point| point.error);
    errors.iter().try_for_each(|error| {
        let error_d = error.to_num::<f64>();
        if error_d.abs() <= MAX_ERROR_D {
            Ok(())
        } else {
            Err(TableError::Error { point, error_d })
        }
    })
}

fn in_d(position: Position) -> f64 {
    position.to_num()
}

/// Why a table was refused; points are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableError {
    /// Too few points or too many.
    Points {
        /// How many.
        count: usize,
    },
    /// The memory lent is too small.
    Memory {
        /// Stretches that fit.
        given: usize,
        /// Stretches needed.
        needed: usize,
    },
    /// A point does not lie above the one before, or too far.
    Spacing {
        /// The point.
        point: usize,
        /// How far above the one before, d.
        spacing_d: f64,
    },
    /// An error beyond what a table holds.
    Error {
        /// The point.
        point: usize,
        /// The error, d.
        error_d: f64,
    },
    /// The error changes faster than any screw's.
    Slope {
        /// The point.
        point: usize,
        /// Slope from the point before, d a d.
        slope: f64,
    },
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Points { count } => write!(
                f,
                "the screw table has {count} points: allowed {} to {}",
                POINTS.0, POINTS.1
            ),
            Self::Memory { given, needed } => write!(
                f,
                "the screw table needs room for {needed} stretches, there is room for {given}"
            ),
            Self::Spacing { point, spacing_d } => write!(
                f,
                "point {point} of the screw table lies {spacing_d} d above the one before: positions must grow, \
                 each by 1/256 to {MAX_SPACING_D} d; sort the points and drop doubles"
            ),
            Self::Error { point, error_d } => write!(
                f,
                "the error at point {point} of the screw table is {error_d} d: allowed -{MAX_ERROR_D} to \
                 {MAX_ERROR_D}; check its unit"
            ),
            Self::Slope { point, slope } => write!(
                f,
                "the error at point {point} of the screw table differs by {slope} d a d from the one before: allowed \
                 up to {MAX_SLOPE}; measure the point anew"
            ),
        }
    }
}

impl core::error::Error for TableError {}
