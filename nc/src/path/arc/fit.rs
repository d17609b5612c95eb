//! The arc nearest to part of a corrected arc, and a bound on how far the two are apart.
//!
//! With r the programmed radius, u(θ) the direction from the programmed centre c, C the fitted centre: the true place is
//! q = c + r·u + K, seen from C it is w = r·u + D with D = c − C + K. What is asked is how far |w| is from the fitted radius.
//! Between samples a function is at most h²/8 times its largest second derivative from its chord. With x = r·cos of the angle
//! between w and u, |D| < r gives x ≥ √(r² − D²), and from w″ = −r·u + D″:
//!
//! |ρ″| ≤ |D″| + (2r|D′| + |D′|² + r|D|) / (x − |D|), and for the angle φ of w
//! |φ″| ≤ (|D| + |D″| + 2(|D| + |D′|)(r + |D′|)/(x − |D|)) / (x − |D|).
//!
//! D′ and D″ are those of K along the arc: |D′| ≤ slope·v, |D″| ≤ bend·v² + slope·r with v the way for a radian.

use std::f64::consts::{PI, TAU};

use super::super::{PathError, Tolerance};
use super::{Arc, ArcPiece};
use crate::coordinates::{Axis, Coordinates};
use crate::terms::{Circumstances, Region, Terms};

/// Samples that the centre is fitted to at least and at most: as many as leave K a tenth of the tolerance between them.
const FITTED: (f64, f64) = (4.0, 16.0);
/// Samples that a piece is proven with at most; one that needs more is halved.
const MAX_SAMPLES: f64 = 4096.0;
/// Share of the tolerance that is left to what lies between samples.
const BETWEEN: f64 = 0.1;
/// Nearer than this, mm, corrected ends are one place.
const CLOSED_MM: f64 = 1e-6;

/// Part of a programmed arc over which the approach does not change.
pub(super) struct Fitting<'a> {
    pub part: &'a Arc,
    /// Where it starts, corrected, as written.
    pub start: Coordinates,
    pub terms: &'a Terms,
    pub with: &'a Circumstances,
    pub tolerance: &'a Tolerance,
}

/// An arc to be proven.
struct Candidate {
    piece: ArcPiece,
    start: Coordinates,
    /// Angle of its start about its centre.
    start_angle: f64,
    /// How far it starts from where K puts its start, mm.
    start_off: f64,
    /// Largest |D|.
    offset: f64,
    /// Largest slope and bend of K in the region.
    slope: f64,
    bend: f64,
}

impl Fitting<'_> {
    /// The arc for the whole part; none if it is not within the tolerance.
    ///
    /// # Errors
    /// A place without a correction.
    pub fn piece(&self) -> Result<Option<ArcPiece>, PathError> {
        let Some(candidate) = self.candidate()? else {
            return Ok(None);
        };
        Ok(self.is_proven(&candidate)?.then_some(candidate.piece))
    }

    fn k(&self, fraction: f64) -> Result<Coordinates, PathError> {
        Ok(self.terms.correction(&self.part.at(fraction), self.with)?)
    }

    /// The centre as far from both ends, less what the program's own radii differ by, that leaves the least spread of radii.
    fn candidate(&self) -> Result<Option<Candidate>, PathError> {
        let part = self.part;
        let steepness = self.terms.steepness(&region(part));
        let length = part.sweep.abs() * self.speed();
        let needed = (steepness.slope * length / (BETWEEN * self.tolerance.mm)).ceil();
        let fitted = needed.max(FITTED.0).min(FITTED.1) as usize;
        let mut samples = Vec::with_capacity(fitted + 1);
        let mut ends = [Coordinates::ZERO; 2];
        for i in 0..=fitted {
            let fraction = i as f64 / fitted as f64;
            let direction = part.direction(fraction);
            let place = if i == 0 {
                part.from
            } else if i == fitted {
                part.to
            } else {
                part.at_direction(fraction, direction)
            };
            let k = self.terms.correction(&place, self.with)?;
            samples.push((direction, part.plane.of(&k)));
            ends[usize::from(i > 0)] = k;
        }
        let [start_k, end_k] = ends;
        let corrected = part.to + end_k;
        let start = relative(part.plane.of(&self.start), part.centre);
        let end = relative(part.plane.of(&corrected), part.centre);
        let end_radius = end[0].hypot(end[1]);
        let widened = (part.radii[1] - part.radii[0]) / end_radius;
        let shift = shift(
            start,
            [end[0] * (1.0 - widened), end[1] * (1.0 - widened)],
            &samples,
        );
        let centre = [part.centre[0] + shift[0], part.centre[1] + shift[1]];
        let start = relative(start, shift);
        let end = relative(end, shift);
        let start_angle = start[1].atan2(start[0]);
        let turned = end[1].atan2(end[0]) - start_angle;
        let sweep = turned + TAU * ((part.sweep - turned) / TAU).round();
        let spacing = length / fitted as f64;
        let offset = samples
            .iter()
            .map(|(_, k)| (k[0] - shift[0]).hypot(k[1] - shift[1]))
            .fold(0.0, f64::max)
            + steepness.slope * spacing
            + (part.radii[1] - part.radii[0]).abs();
        let is_an_arc = sweep * part.sweep > 0.0
            && (sweep - part.sweep).abs() < PI
            && offset < 0.5 * part.radii[0].min(part.radii[1]);
        Ok(is_an_arc.then_some(Candidate {
            piece: ArcPiece {
                to: part.to,
                corrected,
                centre,
                radius: start[0].hypot(start[1]),
                sweep,
            },
            start: self.start,
            start_angle,
            start_off: linear_length(&(part.from + start_k - self.start)),
            offset,
            slope: steepness.slope,
            bend: steepness.bend,
        }))
    }

    /// The way for a radian over all axes.
    fn speed(&self) -> f64 {
        let part = self.part;
        let [first, second] = part.plane.axes();
        let others: f64 = (part.to - part.from)
            .iter()
            .filter(|(axis, _)| *axis != first && *axis != second)
            .map(|(_, way)| (way / part.sweep).powi(2))
            .sum();
        let widening = (part.radii[1] - part.radii[0]) / part.sweep;
        (part.radii[0].max(part.radii[1]).powi(2) + widening.powi(2) + others).sqrt()
    }

    /// Bounds on the second derivatives by the angle of what is off: over linear axes, mm, and over rotary ones, degrees.
    fn second_derivatives(&self, candidate: &Candidate) -> (f64, f64) {
        let part = self.part;
        let v = self.speed();
        let radius = part.radii[0].max(part.radii[1]);
        let widening = ((part.radii[1] - part.radii[0]) / part.sweep).abs();
        let d = candidate.offset;
        let d1 = candidate.slope * v + widening;
        let k2 = candidate.bend * v * v + candidate.slope * (radius + 2.0 * widening);
        let d2 = k2 + 2.0 * widening;
        let smallest = part.radii[0].min(part.radii[1]);
        let near = (smallest * smallest - d * d).max(0.0).sqrt() - d;
        let radial = d2 + (2.0 * radius * d1 + d1 * d1 + radius * d) / near;
        let angular = (d + d2 + 2.0 * (d + d1) * (radius + d1) / near) / near;
        let [mut linear, mut rotary] = [0.0; 2];
        let across = candidate.piece.corrected - candidate.start;
        for axis in self.others() {
            let sum = if axis.is_rotary() {
                &mut rotary
            } else {
                &mut linear
            };
            *sum += (across[axis] / candidate.piece.sweep).abs() * angular;
        }
        (radial + linear + k2, rotary + k2)
    }

    /// Axes out of the plane that move or are corrected.
    fn others(&self) -> impl Iterator<Item = Axis> + '_ {
        let plane = self.part.plane.axes();
        let corrected = self.terms.corrects();
        Axis::ALL.into_iter().filter(move |axis| {
            !plane.contains(axis)
                && (corrected.contains(*axis) || self.part.from[*axis] != self.part.to[*axis])
        })
    }

    /// A bound on what is off everywhere, without samples, mm: small where K hardly changes along the arc. With d the largest
    /// |D| and s what the start is off, |w| and the fitted radius are both within d of r, the latter within d + s; so are their
    /// angles but for a factor 1/r (asin x ≤ 1.1·x below 1/2), at the start, at the end and between.
    fn everywhere(&self, candidate: &Candidate) -> f64 {
        let part = self.part;
        let (d, s) = (candidate.offset, candidate.start_off);
        let radial = 2.0 * d + s;
        let angular = 2.2 * radial / part.radii[0].min(part.radii[1]);
        let across: f64 = self
            .others()
            .map(|axis| (candidate.piece.corrected[axis] - candidate.start[axis]).abs())
            .sum();
        let bend = candidate.slope * self.speed() * part.sweep.abs() / 2.0;
        radial + bend + s + across * angular / candidate.piece.sweep.abs()
    }

    fn is_proven(&self, candidate: &Candidate) -> Result<bool, PathError> {
        if !self.others().any(Axis::is_rotary) && self.everywhere(candidate) <= self.tolerance.mm {
            return Ok(true);
        }
        let (mm, degrees) = self.second_derivatives(candidate);
        let moves_rotary = self.others().any(Axis::is_rotary);
        let rate = (mm / self.tolerance.mm).max(if moves_rotary {
            degrees / self.tolerance.degrees
        } else {
            0.0
        });
        let step = (8.0 * BETWEEN / rate).sqrt();
        let mut ends = self.breaks();
        ends.push(1.0);
        let mut start = 0.0;
        for end in ends {
            let samples = ((end - start) * self.part.sweep.abs() / step)
                .ceil()
                .max(2.0);
            let is_few = samples <= MAX_SAMPLES;
            if !is_few {
                return Ok(false);
            }
            for i in 0..=samples as usize {
                let fraction = start + (end - start) * i as f64 / samples;
                if self.share(candidate, fraction)? > 1.0 - BETWEEN {
                    return Ok(false);
                }
            }
            start = end;
        }
        Ok(true)
    }

    /// How far the true place is from the written path at its angle, in shares of the tolerance.
    fn share(&self, candidate: &Candidate, fraction: f64) -> Result<f64, PathError> {
        let part = self.part;
        let ArcPiece {
            centre,
            radius,
            sweep,
            ..
        } = candidate.piece;
        let place = part.at(fraction) + self.k(fraction)?;
        let w = relative(part.plane.of(&place), centre);
        let expected = radius + fraction * (part.radii[1] - part.radii[0]);
        let radial = w[0].hypot(w[1]) - expected;
        // The angle gone so far, of all that are the same the one next to where it should be.
        let turned = w[1].atan2(w[0]) - candidate.start_angle;
        let turned = turned + TAU * ((fraction * sweep - turned) / TAU).round();
        let written = turned / sweep;
        let mut off = Coordinates::ZERO.with(part.plane.axes()[0], radial);
        for axis in self.others() {
            let way = candidate.piece.corrected[axis] - candidate.start[axis];
            off[axis] = place[axis] - (candidate.start[axis] + written * way);
        }
        Ok(self.tolerance.share(&off))
    }

    /// Fractions of the part at which K breaks, rising.
    fn breaks(&self) -> Vec<f64> {
        let mut all = Vec::new();
        for axis in self.terms.depends_on().iter() {
            self.terms.breaks(axis, &mut |places| {
                all.extend(
                    places
                        .iter()
                        .flat_map(|place| self.part.crosses(axis, *place)),
                );
            });
        }
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
}

/// Length over all linear axes, mm.
fn linear_length(way: &Coordinates) -> f64 {
    let linear = way.iter().filter(|(axis, _)| !axis.is_rotary());
    linear.map(|(_, value)| value * value).sum::<f64>().sqrt()
}

fn relative(place: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [place[0] - to[0], place[1] - to[1]]
}

/// By how much to shift the centre, given the corrected ends seen from the programmed one.
fn shift(start: [f64; 2], end: [f64; 2], samples: &[([f64; 2], [f64; 2])]) -> [f64; 2] {
    let chord = relative(end, start);
    let length = chord[0].hypot(chord[1]);
    if length < CLOSED_MM {
        return mean(samples);
    }
    let squares = |place: [f64; 2]| place[0] * place[0] + place[1] * place[1];
    let along = (squares(end) - squares(start)) / 2.0 / length;
    let unit = [chord[0] / length, chord[1] / length];
    let base = [unit[0] * along, unit[1] * along];
    let beside = [-unit[1], unit[0]];
    // Least spread of the radii over a shift to the side: a straight-line fit of radial K against radial shift.
    let count = samples.len() as f64;
    let points: Vec<(f64, f64)> = samples
        .iter()
        .map(|(u, k)| {
            let rest = relative(*k, base);
            (
                u[0] * beside[0] + u[1] * beside[1],
                u[0] * rest[0] + u[1] * rest[1],
            )
        })
        .collect();
    let mean_g = points.iter().map(|point| point.0).sum::<f64>() / count;
    let mean_f = points.iter().map(|point| point.1).sum::<f64>() / count;
    let (mut spread, mut common) = (0.0, 0.0);
    for (g, f) in points {
        spread += (g - mean_g) * (g - mean_g);
        common += (g - mean_g) * (f - mean_f);
    }
    let side = if spread > 0.0 { common / spread } else { 0.0 };
    [base[0] + side * beside[0], base[1] + side * beside[1]]
}

/// The shift of a full circle.
fn mean(samples: &[([f64; 2], [f64; 2])]) -> [f64; 2] {
    let count = (samples.len() - 1) as f64;
    samples[1..].iter().fold([0.0; 2], |sum, (_, k)| {
        [sum[0] + k[0] / count, sum[1] + k[1] / count]
    })
}

/// A box around an arc: that of its circle and of its ends.
fn region(part: &Arc) -> Region {
    let ends = Region::around(&part.from, &part.to);
    let radius = part.radii[0].max(part.radii[1]);
    let (mut low, mut high) = (ends.low, ends.high);
    for (axis, centre) in part.plane.axes().into_iter().zip(part.centre) {
        low[axis] = centre - radius;
        high[axis] = centre + radius;
    }
    Region { low, high }
}
