//! The figures of P3 as points.

use leadscrew::units::{PAPER_GRAVITY_M_S2, RangeError};

use super::cycle::{Kinematics, frequency_hz};

/// A named line.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its name.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
}

/// Points of a curve.
const POINTS: u32 = 400;
/// The resolution of figure 4, d/mm.
pub const FIGURE_4_COUNTS_PER_MM: f64 = 1000.0;
/// Radii of figure 4, mm.
pub const FIGURE_4_RADII_MM: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 5.0];
/// Overloads of figures 4 and 5, g.
pub const OVERLOADS_G: [f64; 4] = [0.01, 0.1, 1.0, 10.0];
/// Jerks of figure 4, m/s³.
pub const FIGURE_4_JERKS_M_S3: [f64; 4] = [5.0, 50.0, 300.0, 5000.0];
/// Largest radius of figure 3, mm.
pub const FIGURE_3_RADIUS_MM: f64 = 80.0;
/// Largest feed of figure 4, mm/min.
pub const FIGURE_4_FEED_MM_PER_MIN: f64 = 25_000.0;

fn places(from: f64, to: f64) -> impl Iterator<Item = f64> {
    (0..=POINTS).map(move |at| from + (to - from) * f64::from(at) / f64::from(POINTS))
}

/// Figure 3: feeds allowed by acceleration, by jerk if it is watched, and at all, mm/min, against the radius, mm.
#[must_use]
pub fn allowed_feed(axis: &Kinematics, up_to_mm: f64) -> Vec<Curve> {
    let curve = |name: &str, feed: &dyn Fn(f64) -> f64| Curve {
        name: name.to_owned(),
        points: places(0.0, up_to_mm)
            .map(|radius| (radius, feed(radius)))
            .collect(),
    };
    let mut curves = vec![curve("by acceleration", &|radius| {
        axis.feed_by_acceleration(radius)
    })];
    if axis.max_jerk_m_s3().is_some() {
        let by_jerk = |radius| axis.feed_by_jerk(radius).unwrap_or(f64::NAN);
        curves.push(curve("by jerk", &by_jerk));
    }
    curves.push(curve("largest feed", &|_| axis.max_feed_mm_per_min()));
    curves
}

/// The lines of figure 4, Hz against mm/min: first those of radii, then those of overloads, then those of jerks.
///
/// # Errors
/// [`RangeError`] for a resolution or a feed out of range.
pub fn frequency_against_feed(
    counts_per_mm: f64,
    up_to_mm_per_min: f64,
    allowed_d: f64,
) -> Result<[Vec<Curve>; 3], RangeError> {
    let feeds = || places(0.0, up_to_mm_per_min);
    let radii = FIGURE_4_RADII_MM.map(|radius| Curve {
        name: format!("R {radius} mm"),
        points: feeds()
            .map(|feed| (feed, frequency_hz(feed, radius, counts_per_mm, allowed_d)))
            .collect(),
    });
    let mut overloads = Vec::new();
    for overload in OVERLOADS_G {
        let limit = Kinematics::new(
            up_to_mm_per_min,
            overload * PAPER_GRAVITY_M_S2,
            None,
            counts_per_mm,
        )?;
        let frequency = limit.closed_form_hz(allowed_d);
        overloads.push(Curve {
            name: format!("n {overload} g"),
            points: feeds().map(|feed| (feed, frequency)).collect(),
        });
    }
    let jerks = FIGURE_4_JERKS_M_S3.map(|jerk| Curve {
        name: format!("J {jerk} m/s³"),
        points: feeds()
            .skip(1)
            .map(|feed| {
                // The radius on which the jerk allows just this feed, by P3 (11).
                let radius = ((feed / 60.0).powi(3) / (1000.0 * jerk)).sqrt();
                (feed, frequency_hz(feed, radius, counts_per_mm, allowed_d))
            })
            .collect(),
    });
    Ok([radii.into(), overloads, jerks.into()])
}

/// The lines of figure 5: frequency, Hz, against resolution, d/mm, for the overloads; for logarithmic axes.
///
/// # Errors
/// [`RangeError`] for an allowed chord error out of range.
pub fn frequency_against_resolution(allowed_d: f64) -> Result<Vec<Curve>, RangeError> {
    let mut curves = Vec::new();
    for overload in OVERLOADS_G {
        let mut points = Vec::new();
        for exponent in places(3.0, 5.0) {
            let counts_per_mm = 10_f64.powf(exponent);
            let limit =
                Kinematics::new(1000.0, overload * PAPER_GRAVITY_M_S2, None, counts_per_mm)?;
            points.push((counts_per_mm, limit.closed_form_hz(allowed_d)));
        }
        curves.push(Curve {
            name: format!("n {overload} g"),
            points,
        });
    }
    Ok(curves)
}
