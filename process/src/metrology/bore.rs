//! The axis of a hole, boss or turned part from touches in two or more sections: P4 Figure 3.

use nalgebra::Vector3;

use super::error::MetrologyError;
use super::fitted::{Fitted, Settings};
use super::nominal::Nominal;
use super::round::{Radii, Round};
use super::touch::{Touch, vector3};

/// What is taken of the diameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Diameters {
    /// Every section has its own, as in P4.
    OfSections,
    /// A cylinder has one: redundancy from fewer touches.
    Cylinder,
    /// A cone: one at the face and its growth.
    Cone,
}

/// An axis as measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Bore {
    /// Deviation of the axis at the face, mm: Δ_A, Δ_G of P4; 0 where it is not seen.
    pub offset_mm: [f64; 3],
    /// Rotations λ, β, γ of the axis, rad: λ = +∂z/∂y and γ = −∂x/∂y of an axis along y. 0 where it is not seen.
    pub rotation: [f64; 3],
    /// Along which axes its offset is seen: the touches lie on opposite sides. Its rotations are seen about the others.
    pub seen: [bool; 3],
    /// Heights of the sections over the face, mm, and deviations of the diameter there, mm.
    pub sections: Vec<[f64; 2]>,
    /// Deviation of the taper, mm of diameter per mm, of a cone.
    pub taper: Option<f64>,
}

/// Fits an axis. The face is where `nominal.centre_mm` is; the sections are told apart by the planned places. The covariance is
/// that of the offsets as far as seen, their slopes, and the radii (at a cone the radius at the face and half the taper).
///
/// Touches from one side alone tell the diameters, taken about the planned axis.
///
/// # Errors
/// One section alone, or touches that do not determine it.
pub fn fit(
    nominal: &Nominal,
    touches: &[Touch],
    diameters: Diameters,
    settings: &Settings,
) -> Result<Fitted<Bore>, MetrologyError> {
    let radii = match diameters {
        Diameters::OfSections => Radii::OfSections,
        Diameters::Cylinder => Radii::Common,
        Diameters::Cone => Radii::Tapered,
    };
    let model = Round::new(*nominal, touches, true, radii, settings)?;
    if model.sections.len() < 2 {
        return Err(MetrologyError::Impossible {
            what: "an axis",
            reason: "all touches lie in one section".to_owned(),
        });
    }
    read(&model, nominal, touches, settings)
}

/// Fits a turned part: its diameter, with two sections and more its taper too, and with touches on opposite sides its axis.
/// The face, where diameter and axis are told, is where `nominal.centre_mm` is. The covariance is as that of [`fit`].
///
/// Touches from one side alone tell diameters about the planned axis: where that is off the spindle's, or tilted, it is read as
/// diameter and taper.
///
/// # Errors
/// Touches that do not belong to it, or do not determine it.
pub fn fit_turned(
    nominal: &Nominal,
    touches: &[Touch],
    settings: &Settings,
) -> Result<Fitted<Bore>, MetrologyError> {
    let model = Round::new(*nominal, touches, true, Radii::Tapered, settings)?;
    if model.sections.len() >= 2 {
        return read(&model, nominal, touches, settings);
    }
    let model = Round::new(*nominal, touches, false, Radii::OfSections, settings)?;
    read(&model, nominal, touches, settings)
}

fn read(
    model: &Round,
    nominal: &Nominal,
    touches: &[Touch],
    settings: &Settings,
) -> Result<Fitted<Bore>, MetrologyError> {
    let adjusted = model.fit(touches, settings)?;
    let reader = Reader { model, nominal };
    let sigma = adjusted
        .has_sigma()
        .then(|| reader.sigma(&adjusted.covariance));
    Ok(Fitted {
        value: reader.value(&adjusted.unknowns),
        sigma,
        covariance: adjusted.covariance,
        quality: adjusted.quality,
    })
}

struct Reader<'a> {
    model: &'a Round,
    nominal: &'a Nominal,
}

impl Reader<'_> {
    fn value(&self, unknowns: &[f64]) -> Bore {
        let (centre, rest) = unknowns.split_at(self.model.seen.len());
        let (slope, radii) = rest.split_at(self.model.first_radius() - centre.len());
        // ω = axis × slope.
        let rotation = self.axis().cross(&self.model.across(slope));
        let sections = self.model.sections.iter().enumerate();
        let diameter = |(index, &height): (usize, &f64)| {
            let radius = match self.model.radii {
                Radii::Common => radii[0],
                Radii::OfSections => radii[index],
                Radii::Tapered => radii[0] + radii[1] * height,
            };
            [height, 2.0 * radius]
        };
        Bore {
            offset_mm: self.model.across(centre).into(),
            rotation: rotation.into(),
            seen: self.model.seen_axes(),
            sections: sections.map(diameter).collect(),
            taper: (self.model.radii == Radii::Tapered).then(|| 2.0 * radii[1]),
        }
    }

    /// 1σ of each value; heights of sections are known.
    fn sigma(&self, covariance: &nalgebra::DMatrix<f64>) -> Bore {
        let sigmas: Vec<f64> = covariance.diagonal().iter().map(|one| one.sqrt()).collect();
        let mut bore = self.value(&sigmas);
        bore.rotation = bore.rotation.map(f64::abs);
        if self.model.radii == Radii::Tapered {
            let first = self.model.first_radius();
            for section in &mut bore.sections {
                let height = section[0];
                let variance = covariance[(first, first)]
                    + 2.0 * height * covariance[(first, first + 1)]
                    + height * height * covariance[(first + 1, first + 1)];
                section[1] = 2.0 * variance.max(0.0).sqrt();
            }
        }
        bore
    }

    fn axis(&self) -> Vector3<f64> {
        vector3(self.nominal.axis.unit())
    }
}
