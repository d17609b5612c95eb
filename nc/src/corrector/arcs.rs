//! Arcs: `programmed` reads them, here they are corrected, `say` writes them, `check` and `written_arc` see them as the control will.

mod check;
mod programmed;
mod say;
mod written_arc;

use std::f64::consts::TAU;

use programmed::Form;

use super::Task;
use super::instruction::Found;
use super::known::Known;
use super::legs::Leg;
use super::places::Goals;
use super::refusal::{Reason, Within};
use crate::coordinates::{Axis, AxisSet, Coordinates};
use crate::path::arc::{Arc, Piece, corrected};
use crate::terms::{Circumstances, Shape};

/// Share of the tolerance that rounding of R may take; what the arc is off besides has the rest.
const OF_RADIUS: f64 = 0.5;

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
        let legs = self.legs_of(&arc, form, &from, &with)?;
        self.check_pieces(legs.len(), within)?;
        let after = Circumstances {
            approach: arc.approach_after(with.approach),
            ..with
        };
        self.lead(&goals, &from, &legs, &after)
    }

    fn legs_of(
        &self,
        arc: &Arc,
        form: Form,
        from: &Coordinates,
        with: &Circumstances,
    ) -> Result<Vec<Leg>, Found> {
        let Known { terms, .. } = &*self.known;
        let tolerance = &match form {
            Form::Radius(_) => self.known.tolerance.part(1.0 - OF_RADIUS),
            Form::Centre => self.known.tolerance,
        };
        let started = self.started_with(&self.correction_here(from)?);
        let pieces = corrected(arc, &started, terms, with, tolerance);
        let pieces = pieces.map_err(|error| (self.at(), Reason::Path(error)))?;
        Ok(pieces.into_iter().map(leg).collect())
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

    /// True where a line has to lead to the start of an arc under one K everywhere: it stands farther off than the control allows, or
    /// the arc is a full circle, which ends where it begins, so that there is no other place where the control could come to
    /// stand right.
    fn is_led_to(&self, arc: &Arc) -> Result<bool, Found> {
        let k = self.correction(&arc.from, &self.standing_circumstances(), self.at())?;
        let applied = self.applied();
        let [off_x, off_y] = arc.plane.of(&(k - applied));
        let mut plane = arc.plane.axes().into_iter();
        let is_off = plane.any(|axis| !self.scale(axis).says(applied[axis], k[axis]));
        Ok(off_x.hypot(off_y) > self.known.radius_tolerance_mm || arc.is_closed() && is_off)
    }

    /// With one K everywhere the arc stays the arc it is.
    fn moved_arc(&mut self, goals: &Goals, arc: &Arc) -> Result<(), Found> {
        let at = self.at();
        let k = self.correction(&arc.to, &self.circumstances(goals), at)?;
        let ([x, y], [k_x, k_y]) = (arc.centre, arc.plane.of(&k));
        let circle = Circle {
            centre: [x + k_x, y + k_y],
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
