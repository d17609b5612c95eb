//! A shoulder: width and turn from touches along one line of a face, P4's points 4 and 5.

use super::error::MetrologyError;
use super::fitted::{Fitted, Settings};
use super::flat::Flat;
use super::touch::{Axis, Touch, vector3};

/// How a face lies along one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shoulder {
    /// Deviation where the coordinate along the shoulder is 0, Δ_B of P4, mm.
    pub offset_mm: f64,
    /// Rotation about the axis square to the normal and the shoulder, rad: γ at a face square to y along x.
    pub turn: f64,
    /// The axis of that rotation.
    pub about: Axis,
}

/// Fits a shoulder to touches that follow one another `along` an axis. The covariance is that of offset and slope.
///
/// # Errors
/// Fewer than two places, or a face that is not square to an axis other than `along`.
pub fn fit(
    touches: &[Touch],
    along: Axis,
    settings: &Settings,
) -> Result<Fitted<Shoulder>, MetrologyError> {
    let (face, adjusted) = Flat::<false>::fit(touches, |_| vec![vector3(along.unit())], settings)?;
    let normal = Axis::along(face.up.into()).filter(|normal| *normal != along);
    let Some(normal) = normal else {
        return Err(MetrologyError::Misplaced {
            what: "a shoulder",
            touch: 1,
            reason: format!(
                "its face must be square to an axis, and not to {}",
                along.name()
            ),
        });
    };
    let about = if along.next() == normal {
        normal.next()
    } else {
        along.next()
    };
    // ω = slope × normal: positive about the third axis where along, normal, about are right-handed.
    let sign = if along.next() == normal { 1.0 } else { -1.0 };
    let sigma = adjusted.has_sigma().then(|| Shoulder {
        offset_mm: adjusted.covariance[(0, 0)].sqrt(),
        turn: adjusted.covariance[(1, 1)].sqrt(),
        about,
    });
    Ok(Fitted {
        value: Shoulder {
            offset_mm: adjusted.unknowns[0],
            turn: sign * adjusted.unknowns[1],
            about,
        },
        sigma,
        covariance: adjusted.covariance,
        quality: adjusted.quality,
    })
}
