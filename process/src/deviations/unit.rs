//! A moving unit of a machine: how it moves, where its frame is, by how much it deviates.

use leadscrew_nc::coordinates::{Axis, Coordinates};
use nalgebra::{Rotation3, Unit as Direction, UnitVector3, Vector3};

use super::error::DeviationError;
use super::law::Law;
use crate::setting_vector::{Component, SettingVector};

/// How a unit moves in the axes of the unit that carries it, when its coordinate grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Along a direction.
    Linear(UnitVector3<f64>),
    /// Right-handed about a direction through the origin of its frame.
    Rotary(UnitVector3<f64>),
}

impl Motion {
    /// The direction along or about which it moves.
    #[must_use]
    pub fn direction(&self) -> &UnitVector3<f64> {
        let (Self::Linear(direction) | Self::Rotary(direction)) = self;
        direction
    }

    /// True for a rotary unit.
    #[must_use]
    pub const fn is_rotary(&self) -> bool {
        matches!(self, Self::Rotary(_))
    }

    /// The parameter of the setting vector that is the drive's own positioning error: the others come from guideways.
    #[must_use]
    pub fn drive_component(&self) -> Component {
        let axis = self.direction().iamax();
        Component::ALL[axis + if self.is_rotary() { 3 } else { 0 }]
    }
}

/// `+x` … `-z` as a direction; none for another text.
#[must_use]
pub fn direction_of(text: &str) -> Option<UnitVector3<f64>> {
    let (sign, letter) = match text.as_bytes() {
        [b'+', letter] | [letter] => (1.0, letter),
        [b'-', letter] => (-1.0, letter),
        _ => return None,
    };
    let axis = match letter {
        b'x' => Vector3::x(),
        b'y' => Vector3::y(),
        b'z' => Vector3::z(),
        _ => return None,
    };
    Some(Direction::new_unchecked(axis * sign))
}

/// What a unit does while the machine works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// A program axis places it, between two ends: mm or degrees.
    Placed {
        /// The program axis.
        axis: Axis,
        /// Least and largest coordinate.
        range: (f64, f64),
    },
    /// It turns freely, as a spindle: what counts is the mean over a revolution, its axis of rotation. A program axis may place
    /// it at other times.
    Free {
        /// The program axis that can place it.
        axis: Option<Axis>,
    },
}

/// A moving unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// What messages and tables call it.
    pub name: String,
    /// How it moves.
    pub motion: Motion,
    /// What moves it.
    pub drive: Drive,
    /// Place of the origin of its frame in the frame of the unit that carries it (of the machine for the first), its coordinate
    /// at 0, mm.
    pub frame_mm: Vector3<f64>,
    /// True where corrections of the program may use its axis.
    pub corrected: bool,
    /// Its setting vector over its coordinate, in the axes of the unit that carries it.
    pub law: Law,
}

impl Unit {
    /// The program axis that places it now.
    #[must_use]
    pub const fn axis(&self) -> Option<Axis> {
        match self.drive {
            Drive::Placed { axis, .. } => Some(axis),
            Drive::Free { .. } => None,
        }
    }

    /// Its coordinate, mm or degrees; 0 where it turns freely.
    ///
    /// # Errors
    /// A coordinate beyond its ends.
    pub fn coordinate(&self, at: &Coordinates) -> Result<f64, DeviationError> {
        let Drive::Placed { axis, range } = self.drive else {
            return Ok(0.0);
        };
        let value = at[axis];
        if !(range.0..=range.1).contains(&value) {
            return Err(DeviationError::OutOfRange {
                unit: self.name.clone(),
                axis,
                value,
                range,
            });
        }
        Ok(value)
    }

    /// Its setting vector at a coordinate.
    #[must_use]
    pub fn setting(&self, coordinate: f64) -> SettingVector {
        match self.drive {
            Drive::Placed { .. } => self.law.at(coordinate),
            Drive::Free { .. } => self.law.mean(),
        }
    }

    /// Nominal place of the origin of its frame in the frame of the unit that carries it, mm.
    #[must_use]
    pub fn origin(&self, coordinate: f64) -> Vector3<f64> {
        match &self.motion {
            Motion::Linear(along) => self.frame_mm + along.into_inner() * coordinate,
            Motion::Rotary(_) => self.frame_mm,
        }
    }

    /// Nominal rotation of its frame in the frame of the unit that carries it.
    #[must_use]
    pub fn rotation(&self, coordinate: f64) -> Rotation3<f64> {
        match &self.motion {
            Motion::Linear(_) => Rotation3::identity(),
            Motion::Rotary(about) => Rotation3::from_axis_angle(about, coordinate.to_radians()),
        }
    }
}
