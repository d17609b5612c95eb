//! Places and differences of places of a machine with up to nine axes.

use std::fmt;
use std::ops::{Add, AddAssign, Index, IndexMut, Mul, Neg, Sub};

use serde::{Deserialize, Serialize};

/// Number of axis letters of a program.
pub const AXES: usize = 9;

/// An axis, by its letter. Everywhere in this order. U, V and W are axes only where the dialect says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the letter says all")]
pub enum Axis {
    X,
    Y,
    Z,
    A,
    B,
    C,
    U,
    V,
    W,
}

impl Axis {
    /// All of them, in their order.
    pub const ALL: [Self; AXES] = [
        Self::X,
        Self::Y,
        Self::Z,
        Self::A,
        Self::B,
        Self::C,
        Self::U,
        Self::V,
        Self::W,
    ];

    /// Its place in [`Axis::ALL`].
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Its letter, upper case.
    #[must_use]
    pub const fn letter(self) -> char {
        match self {
            Self::X => 'X',
            Self::Y => 'Y',
            Self::Z => 'Z',
            Self::A => 'A',
            Self::B => 'B',
            Self::C => 'C',
            Self::U => 'U',
            Self::V => 'V',
            Self::W => 'W',
        }
    }

    /// The axis of a letter, upper or lower case.
    #[must_use]
    pub fn from_letter(letter: char) -> Option<Self> {
        let upper = letter.to_ascii_uppercase();
        Self::ALL.into_iter().find(|axis| axis.letter() == upper)
    }

    /// True for A, B and C, whose coordinates are degrees.
    #[must_use]
    pub const fn is_rotary(self) -> bool {
        matches!(self, Self::A | Self::B | Self::C)
    }

    /// The unit of its coordinates: `mm`, or `deg` for A, B and C.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        if self.is_rotary() { "deg" } else { "mm" }
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.letter())
    }
}

/// Some of the axes.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct AxisSet(u16);

impl AxisSet {
    /// No axis.
    pub const NONE: Self = Self(0);

    /// This one axis.
    #[must_use]
    pub const fn of(axis: Axis) -> Self {
        Self(1 << axis.index())
    }

    /// With one axis more.
    #[must_use]
    pub const fn with(self, axis: Axis) -> Self {
        Self(self.0 | Self::of(axis).0)
    }

    /// The axes of either.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The axes of both.
    #[must_use]
    pub const fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// True where the axis is one of them.
    #[must_use]
    pub const fn contains(self, axis: Axis) -> bool {
        self.0 & Self::of(axis).0 != 0
    }

    /// True where there is none.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Its axes, in their order.
    pub fn iter(self) -> impl Iterator<Item = Axis> {
        Axis::ALL
            .into_iter()
            .filter(move |axis| self.contains(*axis))
    }
}

impl FromIterator<Axis> for AxisSet {
    fn from_iter<I: IntoIterator<Item = Axis>>(axes: I) -> Self {
        axes.into_iter().fold(Self::NONE, Self::with)
    }
}

/// The letters, `XYZ`.
impl fmt::Display for AxisSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.iter().try_for_each(|axis| write!(f, "{axis}"))
    }
}

impl fmt::Debug for AxisSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "AxisSet({self})")
    }
}

/// A place in machine coordinates, or a difference of places: mm for linear axes, degrees for A, B and C. X of a lathe is a
/// radius here, whatever the program writes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordinates([f64; AXES]);

impl Coordinates {
    /// The origin; no difference.
    pub const ZERO: Self = Self([0.0; AXES]);

    /// From one value an axis, in the order of [`Axis::ALL`].
    #[must_use]
    pub const fn new(values: [f64; AXES]) -> Self {
        Self(values)
    }

    /// With X, Y and Z; 0 in the others.
    #[must_use]
    pub const fn xyz(x: f64, y: f64, z: f64) -> Self {
        Self([x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    }

    /// The same place but for one axis.
    #[must_use]
    pub fn with(mut self, axis: Axis, value: f64) -> Self {
        self[axis] = value;
        self
    }

    /// The place a fraction (0 to 1) of the way to another: 0 here, 1 there. Never beyond either by rounding, so what lies
    /// between places of a table lies in the table.
    #[must_use]
    pub fn towards(&self, other: &Self, fraction: f64) -> Self {
        Self(std::array::from_fn(|i| {
            let (a, b) = (self.0[i], other.0[i]);
            ((1.0 - fraction) * a + fraction * b)
                .max(a.min(b))
                .min(a.max(b))
        }))
    }

    /// Length over X, Y and Z, mm.
    #[must_use]
    pub fn length_mm(&self) -> f64 {
        self.0[..3].iter().map(|v| v * v).sum::<f64>().sqrt()
    }

    /// The values with their axes, in the order of [`Axis::ALL`].
    pub fn iter(&self) -> impl Iterator<Item = (Axis, f64)> + '_ {
        Axis::ALL.into_iter().zip(self.0)
    }

    /// True where no value is infinite or not a number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.0.iter().all(|value| value.is_finite())
    }
}

impl FromIterator<(Axis, f64)> for Coordinates {
    fn from_iter<I: IntoIterator<Item = (Axis, f64)>>(values: I) -> Self {
        values
            .into_iter()
            .fold(Self::ZERO, |all, (axis, value)| all.with(axis, value))
    }
}

impl Index<Axis> for Coordinates {
    type Output = f64;
    fn index(&self, axis: Axis) -> &f64 {
        &self.0[axis.index()]
    }
}

impl IndexMut<Axis> for Coordinates {
    fn index_mut(&mut self, axis: Axis) -> &mut f64 {
        &mut self.0[axis.index()]
    }
}

impl Add for Coordinates {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl AddAssign for Coordinates {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Coordinates {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Neg for Coordinates {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|v| -v))
    }
}

impl Mul<f64> for Coordinates {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self(self.0.map(|v| v * factor))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_and_axes_belong_together() {
        for axis in Axis::ALL {
            assert_eq!(Axis::from_letter(axis.letter()), Some(axis));
            assert_eq!(Axis::ALL[axis.index()], axis);
        }
        assert_eq!(Axis::from_letter('b'), Some(Axis::B));
        assert_eq!(Axis::from_letter('I'), None);
        assert_eq!((Axis::B.unit(), Axis::W.unit()), ("deg", "mm"));
    }

    #[test]
    fn sets_of_axes() {
        let set: AxisSet = [Axis::Z, Axis::X].into_iter().collect();
        assert_eq!(set.to_string(), "XZ");
        assert!(set.contains(Axis::Z) && !set.contains(Axis::Y));
        assert_eq!(set.intersection(AxisSet::of(Axis::Z)), AxisSet::of(Axis::Z));
        assert!(AxisSet::NONE.is_empty());
    }

    #[test]
    fn sums_and_the_way_between_two_places() {
        let a = Coordinates::xyz(1.0, 2.0, 3.0);
        let b = Coordinates::xyz(3.0, 2.0, -1.0).with(Axis::C, 90.0);
        assert_eq!(a.towards(&b, 0.5), (a + b) * 0.5);
        assert_eq!((b - a)[Axis::Z], -4.0);
        assert_eq!(Coordinates::xyz(3.0, 4.0, 0.0).length_mm(), 5.0);
        assert_eq!(a.towards(&b, 1.0), b);
        let still = Coordinates::xyz(0.1, 0.0, 0.0);
        for i in 0..100 {
            assert_eq!(still.towards(&still, f64::from(i) / 99.0), still);
        }
    }
}
