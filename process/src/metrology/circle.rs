//! A hole or a boss in one section: centre in one or two directions, P4 (2), diameter, ovality, form.

use super::adjustment::{Model, adjust};
use super::error::MetrologyError;
use super::fitted::{Fitted, Settings};
use super::nominal::Nominal;
use super::round::{Radii, Round};
use super::touch::Touch;

/// Two touches are opposite to this angle, rad.
const OPPOSITE: f64 = 1e-3;

/// A hole or a boss as measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Deviation of the centre, mm; 0 where it is not seen.
    pub centre_mm: [f64; 3],
    /// Along which axes the centre is seen.
    pub seen: [bool; 3],
    /// Deviation of the diameter, mm.
    pub diameter_mm: f64,
    /// Largest less smallest diameter, mm; none without diameters in two directions. Of the measured diameters, the mean in each
    /// direction, or with six touches and more, in five directions at the least, of the ellipse that fits best.
    pub ovality_mm: Option<f64>,
    /// Greatest less least residual from the circle, mm; none without redundancy. It holds the noise of the touches too.
    pub form_mm: Option<f64>,
}

/// A diameter between opposite touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diameter {
    /// Indices of the touches.
    pub touches: [usize; 2],
    /// Measured less planned diameter, ΔD of P4, mm.
    pub deviation_mm: f64,
}

/// Fits a circle to touches of one section. The covariance is that of the centre as far as seen, and of the radius.
///
/// With touches on opposite sides along one axis the centre is seen along that axis alone, and the diameter is short by
/// (deviation across)² / diameter.
///
/// # Errors
/// Touches in several sections, from one side alone, or too few.
pub fn fit(
    nominal: &Nominal,
    touches: &[Touch],
    settings: &Settings,
) -> Result<Fitted<Circle>, MetrologyError> {
    let model = Round::new(*nominal, touches, false, Radii::Common, settings)?;
    if model.sections.len() > 1 {
        return Err(MetrologyError::Misplaced {
            what: "a circle",
            touch: 1,
            reason: "the touches lie in several sections: measure an axis".to_owned(),
        });
    }
    if model.seen.is_empty() {
        return Err(MetrologyError::TooFew {
            what: "a circle",
            needed: 2,
            found: 1,
        });
    }
    let adjusted = model.fit(touches, settings)?;
    let seen = model.seen_axes();
    let radius = model.first_radius();
    let quality = &adjusted.quality;
    let form_mm = (quality.freedom > 0).then(|| quality.peak_to_valley_mm());
    let counted: Vec<Touch> = touches
        .iter()
        .zip(&quality.residuals)
        .filter_map(|(touch, left)| (!(quality.left_out && left.is_outlier)).then_some(*touch))
        .collect();
    let ovality = ovality(nominal, &counted, settings);
    let centre_sigma = |index| adjusted.sigma(index).unwrap_or_default();
    let sigma = adjusted.has_sigma().then(|| Circle {
        centre_mm: model
            .across(&(0..radius).map(centre_sigma).collect::<Vec<_>>())
            .into(),
        seen,
        diameter_mm: 2.0 * centre_sigma(radius),
        ovality_mm: ovality.and_then(|(_, sigma)| sigma),
        form_mm: None,
    });
    Ok(Fitted {
        value: Circle {
            centre_mm: model.across(&adjusted.unknowns[..radius]).into(),
            seen,
            diameter_mm: 2.0 * adjusted.unknowns[radius],
            ovality_mm: ovality.map(|(ovality, _)| ovality),
            form_mm,
        },
        sigma,
        covariance: adjusted.covariance,
        quality: adjusted.quality,
    })
}

/// The diameters between touches that lie opposite to each other.
///
/// # Errors
/// Touches that do not belong to a circle.
pub fn diameters(nominal: &Nominal, touches: &[Touch]) -> Result<Vec<Diameter>, MetrologyError> {
    Round::new(
        *nominal,
        touches,
        false,
        Radii::Common,
        &Settings::default(),
    )?;
    Ok(opposite_pairs(nominal, touches))
}

/// Each touch with the first one opposite to it that has no partner yet: repeated touches make a diameter each.
fn opposite_pairs(nominal: &Nominal, touches: &[Touch]) -> Vec<Diameter> {
    let mut pairs: Vec<Diameter> = Vec::new();
    for (index, touch) in touches.iter().enumerate() {
        let outward = nominal.outward(touch);
        let is_free = |other: usize| pairs.iter().all(|pair| !pair.touches.contains(&other));
        let is_opposite = |(other, opposite): &(usize, &Touch)| {
            let across = nominal.outward(opposite);
            outward.dot(&across) < 0.0 && outward.perp(&across).abs() < OPPOSITE && is_free(*other)
        };
        let mut later = touches.iter().enumerate().skip(index + 1);
        let opposite = later.find(is_opposite).filter(|_| is_free(index));
        if let Some((other, opposite)) = opposite {
            pairs.push(Diameter {
                touches: [index, other],
                deviation_mm: nominal.radial_deviation(touch) + nominal.radial_deviation(opposite),
            });
        }
    }
    pairs
}

/// Ovality and its 1σ.
fn ovality(
    nominal: &Nominal,
    touches: &[Touch],
    settings: &Settings,
) -> Option<(f64, Option<f64>)> {
    elliptic(nominal, touches, settings).or_else(|| of_diameters(nominal, touches))
}

/// Of the largest and the smallest diameter by direction, each the mean of those measured there.
fn of_diameters(nominal: &Nominal, touches: &[Touch]) -> Option<(f64, Option<f64>)> {
    let pairs = opposite_pairs(nominal, touches);
    let along = |pair: &Diameter| nominal.outward(&touches[pair.touches[0]]);
    let mut directions: Vec<Vec<Diameter>> = Vec::new();
    for pair in pairs {
        let is_same = |same: &&mut Vec<Diameter>| {
            let parallel = |other| along(&pair).perp(&along(other)).abs() < OPPOSITE;
            same.first().is_some_and(parallel)
        };
        match directions.iter_mut().find(is_same) {
            Some(same) => same.push(pair),
            None => directions.push(vec![pair]),
        }
    }
    if directions.len() < 2 {
        return None;
    }
    let mean = |same: &Vec<Diameter>| {
        same.iter().map(|pair| pair.deviation_mm).sum::<f64>() / same.len() as f64
    };
    let by_size = |a: &&Vec<Diameter>, b: &&Vec<Diameter>| mean(a).total_cmp(&mean(b));
    let largest = directions.iter().max_by(by_size)?;
    let smallest = directions.iter().min_by(by_size)?;
    let variance = |same: &Vec<Diameter>| -> Option<f64> {
        let ends = same.iter().flat_map(|pair| pair.touches);
        let sum: Option<f64> = ends
            .map(|index| Some(touches[index].sigma_mm?.powi(2)))
            .sum();
        Some(sum? / (same.len() * same.len()) as f64)
    };
    let variance = variance(largest).zip(variance(smallest));
    Some((
        mean(largest) - mean(smallest),
        variance.map(|(one, other)| (one + other).sqrt()),
    ))
}

/// Of the ellipse that fits best.
fn elliptic(
    nominal: &Nominal,
    touches: &[Touch],
    settings: &Settings,
) -> Option<(f64, Option<f64>)> {
    if touches.len() < 6 {
        return None;
    }
    let round = Round::new(*nominal, touches, false, Radii::Common, settings).ok()?;
    let ellipse = Ellipse {
        round,
        nominal: *nominal,
    };
    let as_they_are = Settings {
        without_outliers: false,
        ..*settings
    };
    let adjusted = adjust(&ellipse, touches, &as_they_are).ok()?;
    let first = ellipse.round.unknowns();
    let [cosine, sine] = [adjusted.unknowns[first], adjusted.unknowns[first + 1]];
    // The radius swings by this each way, twice a turn.
    let swing = cosine.hypot(sine);
    let sigma = adjusted.has_sigma().then(|| {
        let variance = |row, column| adjusted.covariance[(first + row, first + column)];
        if swing > 0.0 {
            let (c, s) = (cosine / swing, sine / swing);
            4.0 * (c * c * variance(0, 0) + 2.0 * c * s * variance(0, 1) + s * s * variance(1, 1))
                .sqrt()
        } else {
            4.0 * variance(0, 0).max(variance(1, 1)).sqrt()
        }
    });
    Some((4.0 * swing, sigma))
}

/// A circle whose radius swings twice a turn: two more unknowns, of the cosine and the sine of twice the angle.
struct Ellipse {
    round: Round,
    nominal: Nominal,
}

impl Ellipse {
    fn twice(&self, touch: &Touch) -> [f64; 2] {
        let outward = self.nominal.outward(touch);
        [
            outward.x * outward.x - outward.y * outward.y,
            2.0 * outward.x * outward.y,
        ]
    }
}

impl Model for Ellipse {
    const WHAT: &'static str = "an ellipse";

    fn unknowns(&self) -> usize {
        self.round.unknowns() + 2
    }

    fn misfit(&self, touch: &Touch, unknowns: &[f64]) -> f64 {
        let (circle, swings) = unknowns.split_at(self.round.unknowns());
        let [cosine, sine] = self.twice(touch);
        self.round.misfit(touch, circle) - swings[0] * cosine - swings[1] * sine
    }

    fn row(&self, touch: &Touch, unknowns: &[f64]) -> Vec<f64> {
        let mut row = self.round.row(touch, &unknowns[..self.round.unknowns()]);
        row.extend(self.twice(touch));
        row
    }

    fn why_degenerate(&self, _: &[f64]) -> String {
        "they lie in too few directions".to_owned()
    }
}
