//! Parts to touch.

use leadscrew_process::metrology::{Axis, Nominal, Touch};
use leadscrew_process::setting_vector::SettingVector;
use nalgebra::{Rotation3, Vector3};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// Seeded noise.
pub struct Noise(Xoshiro256PlusPlus);

impl Noise {
    pub fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// Above 0, up to 1.
    fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }

    /// Normal with 1σ = 1, by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let length = (-2.0 * self.uniform().ln()).sqrt();
        length * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

pub fn v(vector: [f64; 3]) -> Vector3<f64> {
    Vector3::from(vector)
}

/// Where the probe, coming along its line through the planned place, finds a plane face of a displaced part. Exact.
pub fn touch_plane(displaced: &SettingVector, nominal: [f64; 3], normal: [f64; 3]) -> Touch {
    let turned = Rotation3::new(displaced.turn) * v(normal);
    let place = v(displaced.moved(nominal));
    let along = turned.dot(&(place - v(nominal))) / turned.dot(&v(normal));
    Touch::off_by(nominal, normal, along)
}

/// Where the probe finds a cylinder of a displaced part of which the radius is off, coming square to the planned axis at
/// `angle` at a height. Exact: the line meets the displaced cylinder.
pub fn touch_cylinder(
    displaced: &SettingVector,
    nominal: &Nominal,
    (height, angle): (f64, f64),
    is_hole: bool,
    radius_error: f64,
) -> Touch {
    let [first, second] = nominal.across();
    let outward = v(first.unit()) * angle.cos() + v(second.unit()) * angle.sin();
    let radius = nominal.diameter_mm / 2.0 + nominal.taper / 2.0 * height;
    let centre = v(nominal.centre_mm) + v(nominal.axis.unit()) * height;
    let planned = centre + outward * radius;
    let axis = Rotation3::new(displaced.turn) * v(nominal.axis.unit());
    let origin = v(displaced.moved(nominal.centre_mm));
    // |(p + t·u) − origin| square to the axis equals the radius.
    let across = |vector: Vector3<f64>| vector - axis * axis.dot(&vector);
    let (p, u) = (across(planned - origin), across(outward));
    let true_radius = radius + radius_error;
    let (a, b) = (u.norm_squared(), p.dot(&u));
    let c = p.norm_squared() - true_radius * true_radius;
    let along = (-b + (b * b - a * c).sqrt()) / a;
    let normal = if is_hole { -outward } else { outward };
    Touch::at(
        planned.into(),
        normal.into(),
        (planned + outward * along).into(),
    )
}

/// Angles that divide the turn, rad.
pub fn around(count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |index| index as f64 / count as f64 * std::f64::consts::TAU)
}

/// No displacement.
pub const STILL: SettingVector = SettingVector::ZERO;

/// A square face, touched on a grid.
pub fn face(normal: Axis, height: f64, size: f64, grid: usize) -> Vec<([f64; 3], [f64; 3])> {
    let (first, second) = (normal.next().index(), normal.next().next().index());
    let place = |index: usize| (index as f64 / (grid - 1) as f64 - 0.3) * size;
    let mut places = Vec::new();
    for row in 0..grid {
        for column in 0..grid {
            let mut at = [0.0; 3];
            at[normal.index()] = height;
            at[first] = place(row);
            at[second] = place(column);
            places.push((at, normal.unit()));
        }
    }
    places
}

#[track_caller]
pub fn assert_near(value: f64, expected: f64, bound: f64) {
    assert!(
        (value - expected).abs() <= bound,
        "{value:e} instead of {expected:e}: off by {:e}, allowed {bound:e}",
        value - expected
    );
}

#[track_caller]
pub fn assert_all_near(values: [f64; 3], expected: [f64; 3], bound: f64) {
    for (value, expected) in values.into_iter().zip(expected) {
        assert_near(value, expected, bound);
    }
}
