//! A straight movement under a correction.

use super::cubic::Deviation;
use super::{JUMP, MAX_PIECES, PathError, Tolerance};
use crate::coordinates::Coordinates;
use crate::terms::{Circumstances, Region, Shape, Terms};

/// A stretch of the line over which K is one cubic.
struct Stretch {
    /// Fraction of the way at its end.
    until: f64,
    /// K at its end.
    k: Coordinates,
    /// How far K is from its own chord over the stretch, in shares of the tolerance.
    bend: f64,
}

/// Bend of a stretch at most, in shares of the tolerance: with a reversal that is not taken up a single stretch is within it.
const BEND: f64 = 0.25;

/// The places, uncorrected, over which a straight movement has to be led so that the lines between the corrected places stay
/// within the tolerance of the truly corrected path ([`crate::path`] says what that is); the last is `to`.
///
/// `started_with` is K that the machine really stands at `from` with. Where an axis turns round, a screw map wants another K
/// there; if that differs by more than half of the tolerance, the first place is `from` itself: the reversal is taken up before the
/// movement. `with` has the direction of this movement.
///
/// # Errors
/// A place without a correction, or too many pieces.
pub fn split(
    from: &Coordinates,
    to: &Coordinates,
    started_with: &Coordinates,
    terms: &Terms,
    with: &Circumstances,
    tolerance: &Tolerance,
) -> Result<Vec<Coordinates>, PathError> {
    let mut places = Vec::new();
    if terms.shape() <= Shape::Affine {
        // K at both ends is asked for by who writes the words; only that it exists matters here.
        places.push(*to);
        return Ok(places);
    }
    let at_start = terms.correction(from, with)?;
    let mut from_k = *started_with;
    let jump = tolerance.share(&(at_start - *started_with));
    if jump > JUMP {
        places.push(*from);
        from_k = at_start;
    }
    let line = Line {
        from,
        to,
        terms,
        with,
        tolerance,
    };
    let stretches = line.stretches(at_start)?;
    for fraction in merged(&stretches, at_start, from_k, tolerance) {
        places.push(if fraction >= 1.0 {
            *to
        } else {
            from.towards(to, fraction)
        });
    }
    Ok(places)
}

/// The ends of as few chords as go: each reaches as far as the bound of all stretches under it allows.
///
/// Within a stretch the true K is its chord and its bend; the chord of the stretch is farthest from a longer one at its ends.
fn merged(
    stretches: &[Stretch],
    at_start: Coordinates,
    started_with: Coordinates,
    tolerance: &Tolerance,
) -> Vec<f64> {
    let mut ends = Vec::new();
    let mut first = 0;
    let mut start = (0.0, started_with, at_start);
    while first < stretches.len() {
        let mut last = first;
        let reaches = |candidate: usize| {
            candidate < stretches.len() && covers(&stretches[first..=candidate], &start, tolerance)
        };
        // Farther in doubled steps, then back in halved ones. A K that goes and comes back may be covered farther on, which
        // this misses: it costs a piece, not accuracy.
        let mut step = 1;
        while reaches(last + step) {
            last += step;
            step *= 2;
        }
        while step > 1 {
            step /= 2;
            if reaches(last + step) {
                last += step;
            }
        }
        let end = &stretches[last];
        ends.push(end.until);
        start = (end.until, end.k, end.k);
        first = last + 1;
    }
    ends
}

/// True where one chord over all of the stretches stays within the tolerance.
fn covers(
    stretches: &[Stretch],
    (from, chord_from, true_from): &(f64, Coordinates, Coordinates),
    tolerance: &Tolerance,
) -> bool {
    let Some(end) = stretches.last() else {
        return true;
    };
    let mut before = tolerance.share(&(*chord_from - *true_from));
    for stretch in stretches {
        let inside = (stretch.until - from) / (end.until - from);
        let off = tolerance.share(&(stretch.k - chord_from.towards(&end.k, inside)));
        if before.max(off) + stretch.bend > 1.0 {
            return false;
        }
        before = off;
    }
    true
}

struct Line<'a> {
    from: &'a Coordinates,
    to: &'a Coordinates,
    terms: &'a Terms,
    with: &'a Circumstances,
    tolerance: &'a Tolerance,
}

impl Line<'_> {
    fn k(&self, fraction: f64) -> Result<Coordinates, PathError> {
        Ok(self
            .terms
            .correction(&self.from.towards(self.to, fraction), self.with)?)
    }

    /// Stretches between breaks, halved until each bends by [`BEND`] at most.
    fn stretches(&self, at_start: Coordinates) -> Result<Vec<Stretch>, PathError> {
        let mut all = Vec::new();
        let mut start = (0.0, at_start);
        let mut pending = self.breaks();
        pending.reverse();
        while let Some(until) = pending.last().copied() {
            let end = (until, self.k(until)?);
            let bend = self.bend(start, end)?;
            if all.len() + pending.len() > MAX_PIECES {
                return Err(PathError::TooManyPieces);
            }
            if bend > BEND {
                pending.push(f64::midpoint(start.0, until));
                continue;
            }
            pending.pop();
            let (until, k) = end;
            all.push(Stretch { until, k, bend });
            start = end;
        }
        Ok(all)
    }

    fn bend(
        &self,
        (start, start_k): (f64, Coordinates),
        (end, end_k): (f64, Coordinates),
    ) -> Result<f64, PathError> {
        let inner = |share: f64| self.k(start + (end - start) * share);
        let values = [start_k, inner(1.0 / 3.0)?, inner(2.0 / 3.0)?, end_k];
        Ok(Deviation::from_values(&values).bound(|deviation| self.tolerance.share(deviation)))
    }

    /// Fractions of the way at which K breaks, rising, the end last.
    fn breaks(&self) -> Vec<f64> {
        let mut all = vec![1.0];
        for axis in self.terms.depends_on().iter() {
            let (from, way) = (self.from[axis], self.to[axis] - self.from[axis]);
            if way == 0.0 {
                continue;
            }
            self.terms.breaks(axis, &mut |places| {
                let fractions = places.iter().map(|place| (place - from) / way);
                all.extend(fractions.filter(|fraction| *fraction > 0.0 && *fraction < 1.0));
            });
        }
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
}

/// True where the movement stays one line however K runs between its ends: K changes so little over its length. What
/// [`split`] finds out in more detail, for the many short lines of a program. `at_start` is K at `from` with the direction of this
/// movement, `started_with` as there.
///
/// With |K′| ≤ s over a length L, K is nowhere farther from its own chord than 2·s·L·t·(1 − t) ≤ s·L/2.
#[must_use]
pub fn is_short(
    from: &Coordinates,
    to: &Coordinates,
    started_with: &Coordinates,
    at_start: &Coordinates,
    terms: &Terms,
    tolerance: &Tolerance,
) -> bool {
    let squares: f64 = (*to - *from).iter().map(|(_, way)| way * way).sum();
    let bend = terms.steepness(&Region::around(from, to)).slope * squares.sqrt() / 2.0;
    bend <= BEND * tolerance.mm.min(tolerance.degrees)
        && tolerance.share(&(*at_start - *started_with)) <= JUMP
}
