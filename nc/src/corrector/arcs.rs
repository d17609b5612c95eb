//! Arcs: their ends, and I, J, K or R with them.

use super::Task;
use super::instruction::{Found, Said, count, parameter};
use super::known::Known;
use super::places::Goals;
use super::refusal::{Reason, Within};
use super::straight::Leg;
use super::write::{Scale, default_style};
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

/// What says where the centre is.
#[derive(Clone, Copy, Debug)]
enum Form {
    Radius(usize),
    Centre,
}

const LETTERS: [u8; 3] = *b"IJK";

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
        if self.known.shape <= Shape::Constant {
            return self.moved_arc(&goals, form);
        }
        let (from, to) = self.ends(&goals)?;
        let arc = self.programmed_arc(&goals, from, to, form, clockwise)?;
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
        let started = self.started_with(from)?;
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

    fn form(&self) -> Result<Form, Found> {
        let radius = self.block.words.iter().position(|word| word.letter == b'R');
        let centre = self.said.centre.iter().flatten().next();
        match (radius, centre) {
            (Some(word), None) => Ok(Form::Radius(word)),
            (None, Some(_)) => Ok(Form::Centre),
            (Some(word), Some(_)) => Err((
                self.start_of(word),
                Reason::Unexpected {
                    letter: 'R',
                    with: "I, J and K",
                },
            )),
            (None, None) => Err((
                self.at(),
                Reason::MissingWord {
                    letter: 'R',
                    of: "an arc without I, J, K",
                },
            )),
        }
    }

    /// What a word of the block says of the plane, mm.
    fn value(&self, word: usize) -> Result<f64, Found> {
        let word = &self.block.words[word];
        match word.number() {
            Some(number) => Ok(self.centre_scale().read(number)),
            None => Err((
                word.span().start,
                Reason::Expression(char::from(word.letter)),
            )),
        }
    }

    fn centre_scale(&self) -> Scale {
        Scale::of_centre(&self.known.dialect, &self.now.modes)
    }

    /// The word of the centre along an axis.
    fn centre_word(&self, axis: Axis) -> Option<usize> {
        self.said.centre[axis.index()]
    }

    fn programmed_arc(
        &self,
        goals: &Goals,
        from: Coordinates,
        to: Coordinates,
        form: Form,
        clockwise: bool,
    ) -> Result<Arc, Found> {
        let plane = self.now.modes.plane;
        let tolerance = self.known.radius_tolerance_mm;
        let turns = match parameter(self.block, b'P') {
            Said::Nothing => 1,
            _ => count(self.block, b'P')
                .filter(|turns| (1..=1000).contains(turns))
                .ok_or_else(|| {
                    (
                        self.at(),
                        Reason::Number {
                            letter: 'P',
                            expected: "a number of turns, 1 to 1000",
                        },
                    )
                })?,
        };
        let arc = match form {
            Form::Radius(word) => Arc::from_radius(
                plane,
                from,
                to,
                self.value(word)?,
                clockwise,
                turns,
                tolerance,
            ),
            Form::Centre => {
                let centre = plane
                    .axes()
                    .map(|axis| self.centre_along(axis, goals, &from, &to));
                let [first, second] = centre;
                Arc::from_centre(
                    plane,
                    from,
                    to,
                    [first?, second?],
                    clockwise,
                    turns,
                    tolerance,
                )
            }
        };
        arc.map_err(|error| (self.at(), Reason::Path(error)))
    }

    /// The programmed centre, in the coordinates of `from` and `to`.
    fn centre_along(
        &self,
        axis: Axis,
        goals: &Goals,
        from: &Coordinates,
        to: &Coordinates,
    ) -> Result<f64, Found> {
        let said = self
            .centre_word(axis)
            .map(|word| self.value(word))
            .transpose()?;
        if !self.now.modes.centre_absolute {
            return Ok(from[axis] + said.unwrap_or(0.0));
        }
        let goal = &goals[axis.index()];
        let origin = goal
            .program
            .map(|place| to[axis] - place)
            .ok_or_else(|| (self.at(), self.unknown(axis, goal)))?;
        let said = said.ok_or_else(|| {
            let letter = char::from(LETTERS[axis.index()]);
            (
                self.at(),
                Reason::MissingWord {
                    letter,
                    of: "an arc under G90.1",
                },
            )
        })?;
        Ok(said + origin)
    }

    /// K that the control stands with, the remainders of rounding left out.
    pub fn started_with(&self, from: &Coordinates) -> Result<Coordinates, Found> {
        let k = self.correction(from, &self.standing_circumstances(), self.at())?;
        let applied = self.applied();
        let mut started = applied;
        for axis in Axis::ALL {
            if self.scale(axis).says(applied[axis], k[axis]) {
                started[axis] = k[axis];
            }
        }
        Ok(started)
    }

    /// With one K everywhere the arc stays the arc it is.
    fn moved_arc(&mut self, goals: &Goals, form: Form) -> Result<(), Found> {
        let at = self.at();
        let place = self.place(goals, at)?;
        let k = self.correction(&place, &self.circumstances(goals), at)?;
        let started = self.applied();
        let [first, second] = self.now.modes.plane.axes();
        let by_mm = (k[first] - started[first]).hypot(k[second] - started[second]);
        if by_mm > self.known.radius_tolerance_mm {
            return Err((at, Reason::ArcStart { by_mm }));
        }
        if let Form::Centre = form {
            for axis in [first, second] {
                let Some(word) = self.centre_word(axis) else {
                    continue;
                };
                let by = if self.now.modes.centre_absolute {
                    k[axis] - self.now.axes[axis.index()].bias()
                } else {
                    k[axis] - started[axis]
                };
                let value = self.value(word)? + by;
                self.rewrite(word, value, &self.centre_scale())?;
            }
            return self.say(goals, &k, AxisSet::NONE);
        }
        self.say(goals, &k, AxisSet::NONE)?;
        self.check_moved_radius(goals, form, &started, &k)
    }

    /// R stays; the remainders of rounding at both ends must not move the centre that the control works out.
    fn check_moved_radius(
        &self,
        goals: &Goals,
        form: Form,
        started: &Coordinates,
        k: &Coordinates,
    ) -> Result<(), Found> {
        let Form::Radius(word) = form else {
            return Ok(());
        };
        let plane = self.now.modes.plane;
        let (mut from, mut way, mut to) = (Coordinates::ZERO, Coordinates::ZERO, Coordinates::ZERO);
        for axis in plane.axes() {
            way[axis] = goals[axis.index()].way;
            from[axis] = started[axis];
            to[axis] = way[axis] + self.now.axes[axis.index()].applied;
        }
        let radius = self.value(word)?;
        let tolerance = self.known.radius_tolerance_mm;
        let arc = |from, to| Arc::from_radius(plane, from, to, radius, false, 1, tolerance);
        let (Ok(meant), Ok(written)) = (arc(Coordinates::ZERO, way), arc(from, to)) else {
            return Ok(());
        };
        let [first, second] = plane.axes();
        let off_mm = (written.centre[0] - meant.centre[0] - k[first])
            .hypot(written.centre[1] - meant.centre[1] - k[second]);
        if off_mm > self.known.tolerance.mm {
            return Err((self.at(), Reason::RadiusForm { off_mm }));
        }
        Ok(())
    }

    /// Writes a leg along a circle into the block.
    pub fn say_circle(
        &mut self,
        goals: &Goals,
        k: &Coordinates,
        circle: &Circle,
    ) -> Result<(), Found> {
        let started = self.applied();
        let standing = self.now.modes.plane.axes().map(|axis| goals[axis.index()]);
        let moves = standing.iter().any(|goal| goal.way != 0.0);
        let plane: AxisSet = self.now.modes.plane.axes().into_iter().collect();
        let force = if moves {
            self.named().union(plane)
        } else {
            self.named()
        };
        let scale = self.centre_scale();
        match self.form()? {
            Form::Radius(word) => {
                self.say(goals, k, force)?;
                let radius = self.radius_to_say(goals, &started, circle)?;
                self.rewrite(word, radius, &scale)?;
                return Ok(());
            }
            Form::Centre => {
                for (axis, value) in self.centre_words(goals, &started, circle) {
                    match self.centre_word(axis) {
                        Some(word) => {
                            self.rewrite(word, value, &scale)?;
                        }
                        None if scale.says(value, 0.0) && !self.now.modes.centre_absolute => {}
                        None => {
                            let letter = LETTERS[axis.index()];
                            let end = self.block.words[self
                                .said
                                .centre
                                .iter()
                                .flatten()
                                .copied()
                                .max()
                                .unwrap_or(0)]
                            .span()
                            .end;
                            let style = self.centre_style(letter);
                            self.insert_word(end, true, letter, value, &scale, style)?;
                        }
                    }
                }
            }
        }
        self.say(goals, k, force)?;
        self.check_radii(goals, &started, circle)
    }

    /// The words of the centre in a block beside this one.
    pub fn add_circle(
        &self,
        goals: &Goals,
        started: &Coordinates,
        circle: &Circle,
        text: &mut Vec<u8>,
    ) -> Result<(), Found> {
        let scale = self.centre_scale();
        if let Form::Radius(word) = self.form()? {
            let style = self.block.words[word].number();
            let style = style.unwrap_or_else(|| default_style(&self.known.dialect, b'R'));
            let radius = self.radius_to_say(goals, started, circle)?;
            self.add_word(b'R', radius, &scale, style, text)?;
            return Ok(());
        }
        for (axis, value) in self.centre_words(goals, started, circle) {
            let letter = LETTERS[axis.index()];
            let style = self.centre_style(letter);
            self.add_word(letter, value, &scale, style, text)?;
        }
        self.check_radii(goals, started, circle)
    }

    fn centre_style(&self, letter: u8) -> crate::block::Number {
        let other = self.said.centre.iter().flatten().next();
        let style = other.and_then(|word| self.block.words[*word].number());
        style.map_or_else(
            || default_style(&self.known.dialect, letter),
            |style| {
                crate::block::Number::style(
                    style.sign_shown(),
                    1,
                    style.decimals(),
                    style.has_point(),
                )
            },
        )
    }

    /// What I, J, K say: from where the control really stands at the start of the leg, `started` with.
    fn centre_words(
        &self,
        goals: &Goals,
        started: &Coordinates,
        circle: &Circle,
    ) -> [(Axis, f64); 2] {
        let mut index = 0;
        self.now.modes.plane.axes().map(|axis| {
            let goal = &goals[axis.index()];
            let centre = circle.centre[index];
            index += 1;
            let to = circle_frame(goal);
            let value = if self.now.modes.centre_absolute {
                let origin = goal.program.map_or(0.0, |place| to - place);
                centre - origin - self.now.axes[axis.index()].bias()
            } else {
                centre - (to - goal.way + started[axis])
            };
            (axis, value)
        })
    }

    /// R as it can be written, with which the control, that works out the centre from the ends written, comes nearest to the
    /// circle. Near to half a turn a last digit of R moves the centre by many: √(R² − half²).
    fn radius_to_say(
        &self,
        goals: &Goals,
        started: &Coordinates,
        circle: &Circle,
    ) -> Result<f64, Found> {
        let plane = self.now.modes.plane;
        let (mut from, mut to) = (Coordinates::ZERO, Coordinates::ZERO);
        for axis in plane.axes() {
            let goal = &goals[axis.index()];
            from[axis] = circle_frame(goal) - goal.way + started[axis];
            to[axis] = circle_frame(goal) + self.now.axes[axis.index()].applied;
        }
        let off = |radius: f64| {
            let tolerance = self.known.radius_tolerance_mm;
            let clockwise = circle.sweep < 0.0;
            let arc = Arc::from_radius(plane, from, to, radius, clockwise, 1, tolerance);
            arc.map_or(f64::INFINITY, |arc| {
                let [x, y] = arc.centre;
                let centre = (x - circle.centre[0]).hypot(y - circle.centre[1]);
                centre + (arc.radii[0] - circle.radius).abs()
            })
        };
        let exact = circle.signed_radius();
        let scale = self.centre_scale();
        let nearest = scale
            .nearest(exact, b'R')
            .map_err(|reason| (self.at(), reason))?
            .1;
        let step = scale.step();
        let (radius, off_mm) = [nearest, nearest - step, nearest + step]
            .map(|radius| (radius, off(radius)))
            .into_iter()
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((nearest, f64::INFINITY));
        if off_mm > self.known.tolerance.mm {
            return Err((self.at(), Reason::RadiusForm { off_mm }));
        }
        Ok(radius)
    }

    /// What the control will find: radii at both ends of what was written.
    fn check_radii(
        &self,
        goals: &Goals,
        started: &Coordinates,
        circle: &Circle,
    ) -> Result<(), Found> {
        let axes = self.now.modes.plane.axes();
        let mut start = [0.0; 2];
        let mut end = [0.0; 2];
        for (index, axis) in axes.into_iter().enumerate() {
            let goal = &goals[axis.index()];
            let to = circle_frame(goal);
            start[index] = to - goal.way + started[axis] - circle.centre[index];
            end[index] = to + self.now.axes[axis.index()].applied - circle.centre[index];
        }
        let (start_mm, end_mm) = (start[0].hypot(start[1]), end[0].hypot(end[1]));
        let tolerance_mm = self.known.radius_tolerance_mm;
        if (start_mm - end_mm).abs() > tolerance_mm {
            return Err((
                self.at(),
                Reason::Path(PathError::Radii {
                    start_mm,
                    end_mm,
                    tolerance_mm,
                }),
            ));
        }
        Ok(())
    }
}

/// A goal in the coordinates of legs.
fn circle_frame(goal: &super::Goal) -> f64 {
    goal.machine.or(goal.program).unwrap_or(0.0)
}

impl Circle {
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
