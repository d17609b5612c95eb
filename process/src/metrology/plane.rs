//! A plane from three or more touches: offset at the origin and rotations, P4 (1).

use nalgebra::Vector3;

use super::error::MetrologyError;
use super::fitted::{Fitted, Settings};
use super::flat::Flat;
use super::touch::{Touch, vector3};

/// How a plane lies against its planned place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Deviation at the origin, Δ_G of P4 (1), mm: along the axis that the face is square to, positive along it whichever
    /// way the face looks. At an oblique face along its normal, taken with its largest coordinate positive.
    pub offset_mm: f64,
    /// Rotations λ, β, γ, rad. The one about the normal is not seen, and 0.
    pub rotation: [f64; 3],
}

/// Fits a plane to touches of one face. The covariance is that of the offset and of the slopes along two directions.
///
/// # Errors
/// Fewer than three touches, touches on one line, or of faces that look different ways.
pub fn fit(touches: &[Touch], settings: &Settings) -> Result<Fitted<Plane>, MetrologyError> {
    let (face, adjusted) = Flat::<true>::fit(touches, |up| frame(up).to_vec(), settings)?;
    // ω = slope × normal: at z λ = ∂z/∂y and β = −∂z/∂x.
    let rotation = face.slope(&adjusted.unknowns).cross(&face.up);
    let sigma = adjusted.has_sigma().then(|| Plane {
        offset_mm: adjusted.covariance[(0, 0)].sqrt(),
        rotation: Vector3::from_fn(|axis, _| {
            let mut unit = Vector3::zeros();
            unit[axis] = 1.0;
            // ω·e = (slope × up)·e = slope·(up × e).
            let along = face.up.cross(&unit);
            let parts = [
                face.directions[0].dot(&along),
                face.directions[1].dot(&along),
            ];
            let slopes = adjusted.covariance.fixed_view::<2, 2>(1, 1);
            let parts = nalgebra::Vector2::from(parts);
            (parts.transpose() * slopes * parts)[(0, 0)].max(0.0).sqrt()
        })
        .into(),
    });
    Ok(Fitted {
        value: Plane {
            offset_mm: adjusted.unknowns[0],
            rotation: rotation.into(),
        },
        sigma,
        covariance: adjusted.covariance,
        quality: adjusted.quality,
    })
}

/// Two directions square to `up`: the next two axes where it lies along one.
pub(super) fn frame(up: Vector3<f64>) -> [Vector3<f64>; 2] {
    let next = super::Axis::ALL[up.iamax()].next();
    let second = up.cross(&vector3(next.unit())).normalize();
    [second.cross(&up), second]
}
