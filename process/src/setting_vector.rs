//! The setting vector ω = (a, b, c, λ, β, γ) of P4: how a unit of a machine or a whole workpiece lies beside where it should, and its
//! reduction to another place.

use std::fmt;
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

use nalgebra::{Isometry3, Matrix6, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use serde::Deserialize;

/// One of the six parameters of a setting vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Component {
    /// Shift along x.
    A,
    /// Shift along y.
    B,
    /// Shift along z.
    C,
    /// Turn about x.
    Lambda,
    /// Turn about y.
    Beta,
    /// Turn about z.
    Gamma,
}

impl Component {
    /// All six, in the order of the vector.
    pub const ALL: [Self; 6] = [
        Self::A,
        Self::B,
        Self::C,
        Self::Lambda,
        Self::Beta,
        Self::Gamma,
    ];

    /// Its place in [`Component::ALL`].
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// True for λ, β and γ.
    #[must_use]
    pub const fn is_turn(self) -> bool {
        self.index() >= 3
    }

    /// Its key in files: `a` … `gamma`.
    #[must_use]
    pub const fn key(self) -> &'static str {
        ["a", "b", "c", "lambda", "beta", "gamma"][self.index()]
    }

    /// Its letter in texts: `a` … `γ`.
    #[must_use]
    pub const fn letter(self) -> &'static str {
        ["a", "b", "c", "λ", "β", "γ"][self.index()]
    }
}

impl fmt::Display for Component {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.letter())
    }
}

/// By how much a unit or a workpiece is displaced at its reference frame: a small shift and a small right-handed turn. Taken exactly it
/// is a rigid displacement: first turned about the origin of the frame, then moved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SettingVector {
    /// (a, b, c), mm.
    pub shift: Vector3<f64>,
    /// (λ, β, γ), rad, about x, y and z. Where it is taken exactly, it is a rotation vector.
    pub turn: Vector3<f64>,
}

impl SettingVector {
    /// Where it should be.
    pub const ZERO: Self = Self {
        shift: Vector3::new(0.0, 0.0, 0.0),
        turn: Vector3::new(0.0, 0.0, 0.0),
    };

    /// From (a, b, c, λ, β, γ), mm and rad.
    #[must_use]
    pub const fn new([a, b, c, lambda, beta, gamma]: [f64; 6]) -> Self {
        Self {
            shift: Vector3::new(a, b, c),
            turn: Vector3::new(lambda, beta, gamma),
        }
    }

    /// (a, b, c, λ, β, γ), mm and rad.
    #[must_use]
    pub fn to_array(self) -> [f64; 6] {
        let Self { shift, turn } = self;
        [shift.x, shift.y, shift.z, turn.x, turn.y, turn.z]
    }

    /// One of its parameters, mm or rad.
    #[must_use]
    pub fn get(&self, component: Component) -> f64 {
        self.to_array()[component.index()]
    }

    /// The same vector with another value of one parameter, mm or rad.
    #[must_use]
    pub fn with(self, component: Component, value: f64) -> Self {
        let mut values = self.to_array();
        values[component.index()] = value;
        Self::new(values)
    }

    /// The displacement of the place at `r` from the frame, mm in the frame's axes: W ω with W of [`reduction`].
    #[must_use]
    pub fn reduced(&self, r: &Vector3<f64>) -> Self {
        Self {
            shift: self.shift + self.turn.cross(r),
            turn: self.turn,
        }
    }

    /// The same displacement in the axes that `rotation` leads to.
    #[must_use]
    pub fn rotated(&self, rotation: &Rotation3<f64>) -> Self {
        Self {
            shift: rotation * self.shift,
            turn: rotation * self.turn,
        }
    }

    /// Where a place of the frame comes to lie, mm, exactly.
    #[must_use]
    pub fn moved(&self, place: [f64; 3]) -> [f64; 3] {
        (self.to_isometry() * Point3::from(place)).coords.into()
    }

    /// How far a place is moved, mm, exactly. A tool that is to follow a workpiece set like this is moved by as much; where instead
    /// a machine has cut a workpiece like this, its correction is the negative, K = −Δ.
    #[must_use]
    pub fn displacement_of(&self, place: [f64; 3]) -> [f64; 3] {
        (Vector3::from(self.moved(place)) - Vector3::from(place)).into()
    }

    /// The displacement as a motion with a full rotation.
    #[must_use]
    pub fn to_isometry(self) -> Isometry3<f64> {
        Isometry3::from_parts(
            Translation3::from(self.shift),
            UnitQuaternion::from_scaled_axis(self.turn),
        )
    }

    /// The displacement that a motion is.
    #[must_use]
    pub fn of_isometry(motion: &Isometry3<f64>) -> Self {
        Self {
            shift: motion.translation.vector,
            turn: motion.rotation.scaled_axis(),
        }
    }
}

/// W = [[I, −\[r\]×], [0, I]]: brings a setting vector to the place at `r` from its frame, mm (P4 (5), its matrix of reduction
/// with the scan's slips put right; small angles).
#[must_use]
pub fn reduction(r: &Vector3<f64>) -> Matrix6<f64> {
    let mut w = Matrix6::identity();
    w.fixed_view_mut::<3, 3>(0, 3).copy_from(&-r.cross_matrix());
    w
}

impl Add for SettingVector {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            shift: self.shift + other.shift,
            turn: self.turn + other.turn,
        }
    }
}

impl AddAssign for SettingVector {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Neg for SettingVector {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Sub for SettingVector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul<f64> for SettingVector {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self {
            shift: self.shift * factor,
            turn: self.turn * factor,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_matrix_and_the_cross_product_reduce_alike() {
        let omega = SettingVector::new([1.0, -2.0, 3.0, 0.1, 0.2, -0.3]);
        let r = Vector3::new(10.0, 20.0, -30.0);
        let by_matrix = reduction(&r) * nalgebra::Vector6::from(omega.to_array());
        let by_cross = nalgebra::Vector6::from(omega.reduced(&r).to_array());
        assert!((by_matrix - by_cross).norm() < 1e-12);
    }

    #[test]
    fn a_turn_about_y_moves_what_lies_along_x_to_minus_z() {
        let turned = SettingVector::ZERO.with(Component::Beta, 1e-3);
        let moved = turned.reduced(&Vector3::new(100.0, 0.0, 0.0));
        assert_eq!(moved.shift, Vector3::new(0.0, 0.0, -0.1));
    }

    #[test]
    fn a_small_motion_is_its_own_setting_vector() {
        let omega = SettingVector::new([1e-2, -2e-2, 3e-2, 1e-4, 2e-4, -3e-4]);
        let back = SettingVector::of_isometry(&omega.to_isometry());
        assert!((back - omega).shift.norm() < 1e-12 && (back - omega).turn.norm() < 1e-12);
    }
}
