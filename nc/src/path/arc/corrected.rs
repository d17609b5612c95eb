//! An arc under a correction: one arc where it may stay one, else as few shorter ones as halving finds.

use std::f64::consts::PI;

use super::super::{JUMP, MAX_PIECES, PathError, Tolerance};
use super::Arc;
use super::fit::Fitting;
use crate::coordinates::Coordinates;
use crate::terms::{Circumstances, Shape, Terms};

/// Part of a corrected arc, an arc itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcPiece {
    /// Where it ends, as programmed.
    pub to: Coordinates,
    /// Where it ends, corrected.
    pub corrected: Coordinates,
    /// Its corrected centre in the plane, machine coordinates, mm.
    pub centre: [f64; 2],
    /// Its radius at the corrected start, mm.
    pub radius: f64,
    /// Angle it turns through, rad, positive for G3, with all of its turns.
    pub sweep: f64,
}

/// Part of a corrected arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// A straight line that takes up a reversal of a screw map, at a place where an axis turns round.
    Line {
        /// Where it ends, as programmed.
        to: Coordinates,
        /// Where it ends, corrected.
        corrected: Coordinates,
    },
    /// An arc.
    Arc(ArcPiece),
}

/// Most that one piece turns through where K is not the same everywhere, rad: the ends of more could come so near to each other
/// that rounding takes the arc for a full circle, or for none.
const MAX_SWEEP: f64 = 1.5 * PI;
/// A piece that turns through less, rad, and still is no arc: it will not become one.
const MIN_SWEEP: f64 = 1e-5;

/// What an arc becomes. With one K everywhere it stays the arc it is, moved. Else arcs through the corrected places of its ends
/// that stay within the tolerance of the truly corrected path, split where they do not ([`crate::path`] says what is
/// guaranteed), and where an axis turns round whose screw map wants another K then.
///
/// `started_with` is K that the machine really stands at the start with; `with` has the approach of before the arc.
///
/// # Errors
/// A place without a correction, or too many pieces.
pub fn corrected(
    arc: &Arc,
    started_with: &Coordinates,
    terms: &Terms,
    with: &Circumstances,
    tolerance: &Tolerance,
) -> Result<Vec<Piece>, PathError> {
    if terms.shape() <= Shape::Constant {
        let k = terms.correction(&arc.from, with)?;
        return Ok(moved(arc, started_with, k));
    }
    let mut pieces = Pieces {
        arc,
        terms,
        tolerance,
        written: arc.from + *started_with,
        all: Vec::new(),
    };
    let ends = stretches(arc, terms);
    for pair in ends.windows(2) {
        let middle = f64::midpoint(pair[0], pair[1]);
        let along = Circumstances {
            approach: arc.approach(middle, with.approach),
            ..*with
        };
        pieces.add(pair[0], pair[1], &along)?;
    }
    Ok(pieces.all)
}

/// The same arc elsewhere.
fn moved(arc: &Arc, started_with: &Coordinates, k: Coordinates) -> Vec<Piece> {
    let mut pieces = Vec::new();
    if *started_with != k {
        pieces.push(Piece::Line {
            to: arc.from,
            corrected: arc.from + k,
        });
    }
    let [dx, dy] = arc.plane.of(&k);
    pieces.push(Piece::Arc(ArcPiece {
        to: arc.to,
        corrected: arc.to + k,
        centre: [arc.centre[0] + dx, arc.centre[1] + dy],
        radius: arc.radii[0],
        sweep: arc.sweep,
    }));
    pieces
}

/// Fractions of the way where it is split in any case, both ends among them.
fn stretches(arc: &Arc, terms: &Terms) -> Vec<f64> {
    let directional = terms.depends_on_approach_of();
    let mut ends: Vec<f64> = directional
        .iter()
        .flat_map(|axis| arc.turns_round(axis))
        .collect();
    ends.extend([0.0, 1.0]);
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let mut all = vec![0.0];
    for pair in ends.windows(2) {
        let parts = ((pair[1] - pair[0]) * arc.sweep.abs() / MAX_SWEEP)
            .ceil()
            .clamp(1.0, 1e6);
        let parts = parts as usize;
        all.extend(
            (1..parts).map(|part| pair[0] + (pair[1] - pair[0]) * part as f64 / parts as f64),
        );
        all.push(pair[1]);
    }
    all
}

/// Pieces as they come.
struct Pieces<'a> {
    arc: &'a Arc,
    terms: &'a Terms,
    tolerance: &'a Tolerance,
    /// Where the last one ends, corrected.
    written: Coordinates,
    all: Vec<Piece>,
}

impl Pieces<'_> {
    /// Adds the pieces between two fractions of the way, over which the approach does not change. Where the machine stands so far off
    /// their begin that no piece is an arc, a line leads to it.
    fn add(&mut self, from: f64, until: f64, with: &Circumstances) -> Result<(), PathError> {
        self.take_up(from, with, JUMP)?;
        let mut start = from;
        let mut pending = vec![until];
        while let Some(end) = pending.last().copied() {
            if self.all.len() + pending.len() > MAX_PIECES {
                return Err(PathError::TooManyPieces);
            }
            let part = self.arc.part(start, end);
            let fitting = Fitting {
                part: &part,
                start: self.written,
                terms: self.terms,
                with,
                tolerance: self.tolerance,
            };
            if let Some(piece) = fitting.piece()? {
                pending.pop();
                self.written = piece.corrected;
                self.all.push(Piece::Arc(piece));
                start = end;
            } else if part.sweep.abs() < MIN_SWEEP {
                if start > from || !self.take_up(from, with, 0.0)? {
                    return Err(PathError::NotAnArc);
                }
                pending = vec![until];
            } else {
                pending.push(f64::midpoint(start, end));
            }
        }
        Ok(())
    }

    /// A line to where K of the new direction puts the place, where the machine stands farther from it than a share of the tolerance;
    /// true where it does.
    fn take_up(
        &mut self,
        fraction: f64,
        with: &Circumstances,
        share: f64,
    ) -> Result<bool, PathError> {
        let to = self.arc.at(fraction);
        let corrected = to + self.terms.correction(&to, with)?;
        let is_off = self.tolerance.share(&(corrected - self.written)) > share;
        if is_off {
            self.written = corrected;
            self.all.push(Piece::Line { to, corrected });
        }
        Ok(is_off)
    }
}
