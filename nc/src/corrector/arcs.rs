//! Arcs: `programmed` reads them, here they are corrected, `say` writes them, `check` and `written_arc` see them as the control will.

mod check;
mod programmed;
mod say;
mod written_arc;

use std::f64::consts::TAU;

use super::Task;
use super::instruction::Found;
use super::known::Known;
use super::legs::Leg;
use super::places::Goals;
use super::refusal::{Reason, Within};
use crate::coordinates::{Axis, AxisSet, Coordinates};
use crate::path::PathError;
use crate::path::arc::{Arc, Piece, corrected};
use crate::terms::{Circumstances, Shape};

/// A circle that a leg goes along, corrected.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    /// Its centre in the plane, in the coordinates of [`Leg::to`].
    pub centre: [f64; 2],
    /// Radius, mm.
    pub radius: f64,
    /// Angle turned through, rad.
    pub sweep: f64,
}

impl Task<'_> {
    pub fn arc(&mut self, clockwise: bool, within: Option<Within>) -> Result<(), Found> {
        if let Some(word) = self.said.machine_coordinates {
            return Err((
                self.start_of(word),
                Reason::Unsupported("G53 has no meaning with an arc"),
            ));
        }
        let goals = self.goals()?;
        let form = self.form()?;
        let constant = self.known.shape <= Shape::Constant;
        let mut plane = self.now.modes.plane.axes().into_iter();
        if constant && !plane.any(|axis| self.known.corrects.contains(axis)) {
            return self.single(&goals);
        }
        let (from, to) = self.ends(&goals)?;
        let arc = self.programmed_arc(&goals, from, to, form, clockwise)?;
        if constant && !self.is_led_to(&arc)? {
            return self.moved_arc(&goals, &arc);
        }
        let with = self.standing_circumstances();
        let legs = self.legs_of(&arc, &from, &with)?;
        self.check_pieces(legs.len(), within)?;
        let after = Circumstances {
            approach: arc.approach_after(with.approach),
            ..with
        };
        self.lead(&goals, &from, &legs, &after)
    }

    /// The arc in pieces. Where it begins so far from its circle that no piece is an arc, a line leads to it.
    fn legs_of(
        &self,
        arc: &Arc,
        from: &Coordinates,
        with: &Circumstances,
    ) -> Result<Vec<Leg>, Found> {
        let Known {
            terms, tolerance, ..
        } = &*self.known;
        let started = self.started_with(&self.correction_here(from)?);
        let found = |error| (self.at(), Reason::Path(error));
        match corrected(arc, &started, terms, with, tolerance) {
            Ok(pieces) => Ok(pieces.into_iter().map(leg).collect()),
            Err(PathError::NotAnArc) => {
                let k = self.correction(from, with, self.at())?;
                let pieces = corrected(arc, &k, terms, with, tolerance).map_err(found)?;
                let lead = Leg {
                    to: *from,
                    k,
                    circle: None,
                };
                Ok(std::iter::once(lead)
                    .chain(pieces.into_iter().map(leg))
                    .collect())
            }
            Err(error) => Err(found(error)),
        }
    }

    /// K that the control stands with where K is `here`: the remainders of rounding are left out.
    pub fn started_with(&self, here: &Coordinates) -> Coordinates {
        let applied = self.applied();
        let mut started = applied;
        for axis in Axis::ALL {
            if self.scale(axis).says(applied[axis], here[axis]) {
                started[axis] = here[axis];
            }
        }
        started
    }

    /// True where a line has to lead to the start of a full circle under one K everywhere: it ends where it begins, so there is no
    /// other place where the control could come to stand right.
    fn is_led_to(&self, arc: &Arc) -> Result<bool, Found> {
        let k = self.correction(&arc.from, &self.standing_circumstances(), self.at())?;
        let applied = self.applied();
        let mut plane = arc.plane.axes().into_iter();
        Ok(arc.is_closed() && plane.any(|axis| !self.scale(axis).says(applied[axis], k[axis])))
    }

    /// With one K everywhere the arc stays the arc it is.
    fn moved_arc(&mut self, goals: &Goals, arc: &Arc) -> Result<(), Found> {
        let at = self.at();
        let k = self.correction(&arc.to, &self.circumstances(goals), at)?;
        let started = self.applied();
        let [first, second] = arc.plane.axes();
        let by_mm = (k[first] - started[first]).hypot(k[second] - started[second]);
        if by_mm > self.known.radius_tolerance_mm {
            return Err((at, Reason::ArcStart { by_mm }));
        }
        let [x, y] = arc.centre;
        let circle = Circle {
            centre: [x + k[first], y + k[second]],
            radius: arc.radii[0],
            sweep: arc.sweep,
        };
        self.say_circle(goals, &k, &circle, AxisSet::NONE)
    }
}

/// A goal in the coordinates of legs.
fn circle_frame(goal: &super::Goal) -> f64 {
    goal.machine.or(goal.program).unwrap_or(0.0)
}

impl Circle {
    /// One or more whole turns.
    fn is_full(&self) -> bool {
        let turns = self.sweep.abs() / TAU;
        turns.round() >= 1.0 && (turns - turns.round()).abs() < 1e-9
    }

    /// R of the control: negative for more than half of a circle.
    fn signed_radius(&self) -> f64 {
        if self.sweep.abs() > std::f64::consts::PI {
            -self.radius
        } else {
            self.radius
        }
    }
}

fn leg(piece: Piece) -> Leg {
    match piece {
        Piece::Line { to, corrected } => Leg {
            to,
            k: corrected - to,
            circle: None,
        },
        Piece::Arc(arc) => Leg {
            to: arc.to,
            k: arc.corrected - arc.to,
            circle: Some(Circle {
                centre: arc.centre,
                radius: arc.radius,
                sweep: arc.sweep,
            }),
        },
    }
}
