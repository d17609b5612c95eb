//! Arcs: their ends, and I, J, K or R with them.

use std::f64::consts::TAU;

use super::Task;
use super::instruction::{Found, Said, count, parameter};
use super::known::Known;
use super::places::Goals;
use super::refusal::{Reason, Within};
use super::straight::Leg;
use super::write::{Scale, default_style};
use super::written_arc::{SameEnds, WrittenArc};
use crate::coordinates::{Axis, AxisSet, Coordinates};
use crate::path::PathError;
use crate::path::arc::{Arc, Piece, corrected};
use crate::terms::{Circumstances, ROUNDING, Shape};

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

    /// Writes a leg along a circle into the block, with words for the axes of `force` in any case.
    pub fn say_circle(
        &mut self,
        goals: &Goals,
        k: &Coordinates,
        circle: &Circle,
        force: AxisSet,
    ) -> Result<(), Found> {
        let started = self.applied();
        let (goals, k) = &self.closing(goals, *k, circle);
        self.say_turns(circle)?;
        let scale = self.centre_scale();
        if let Form::Radius(word) = self.form()? {
            self.say(goals, k, force)?;
            let radius = self.radius_to_say(goals, &started, circle)?;
            self.rewrite(word, radius, &scale)?;
            return Ok(());
        }
        let mut centre = circle.centre;
        let words = self.centre_words(goals, &started, circle);
        for (place, (axis, value)) in centre.iter_mut().zip(words) {
            let written = match self.centre_word(axis) {
                Some(word) => self.rewrite(word, value, &scale)?,
                None if scale.says(value, 0.0) && !self.now.modes.centre_absolute => 0.0,
                None => {
                    let letter = LETTERS[axis.index()];
                    let last = self.said.centre.iter().flatten().copied().max();
                    let end = self.block.words[last.unwrap_or(0)].span().end;
                    let style = self.centre_style(letter);
                    self.insert_word(end, true, letter, value, &scale, style)?
                }
            };
            *place += written - value;
        }
        self.say(goals, k, force)?;
        self.check_written(goals, &started, centre, circle)
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
        let mut centre = circle.centre;
        let words = self.centre_words(goals, started, circle);
        for (place, (axis, value)) in centre.iter_mut().zip(words) {
            let letter = LETTERS[axis.index()];
            let style = self.centre_style(letter);
            *place += self.add_word(letter, value, &scale, style, text)? - value;
        }
        self.check_written(goals, started, centre, circle)
    }

    /// Goals and K at the end of a leg: a full circle ends where it starts, to the last digit.
    fn closing(&self, goals: &Goals, mut k: Coordinates, circle: &Circle) -> (Goals, Coordinates) {
        let mut goals = *goals;
        let plane = self.now.modes.plane.axes();
        let stays = |axis: &Axis| goals[axis.index()].way.abs() <= ROUNDING;
        if circle.is_full() && plane.iter().all(stays) {
            for axis in plane {
                goals[axis.index()].exact = true;
                k[axis] = self.now.axes[axis.index()].applied;
            }
        }
        (goals, k)
    }

    /// P counts the turns of the whole arc, of which a leg may have less.
    fn say_turns(&mut self, circle: &Circle) -> Result<(), Found> {
        let turns = (circle.sweep.abs() / TAU - 1e-9).ceil().max(1.0) as i64;
        let word = self.block.words.iter().find(|word| word.letter == b'P');
        let Some((word, number)) = word.and_then(|word| Some((word, word.number()?))) else {
            return Ok(());
        };
        if number.whole() == Some(turns) {
            return Ok(());
        }
        self.edits.put(word.value_span(), |text| {
            number.write_like(turns, 0, false, text);
            Ok(())
        })
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
        let off = |radius: f64| {
            let arc = self.arc_of_radius(goals, started, radius, circle);
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
        let written = self.written_arc(goals, started, circle.centre, SameEnds::NoArc);
        written
            .check_sweep(circle.sweep)
            .map_err(|reason| (self.at(), reason))?;
        if off_mm > self.known.tolerance.mm {
            return Err((self.at(), Reason::RadiusForm { off_mm }));
        }
        Ok(radius)
    }

    /// The arc that the control works out of R and the ends as they are written.
    fn arc_of_radius(
        &self,
        goals: &Goals,
        started: &Coordinates,
        radius: f64,
        circle: &Circle,
    ) -> Result<Arc, PathError> {
        let (from, to) = self.written_ends(goals, started);
        let tolerance = self.known.radius_tolerance_mm;
        let clockwise = circle.sweep < 0.0;
        Arc::from_radius(
            self.now.modes.plane,
            from,
            to,
            radius,
            clockwise,
            1,
            tolerance,
        )
    }

    /// Where the control begins, having started with so much more, and where it ends after what is written.
    fn written_ends(&self, goals: &Goals, started: &Coordinates) -> (Coordinates, Coordinates) {
        let (mut from, mut to) = (Coordinates::ZERO, Coordinates::ZERO);
        for axis in self.now.modes.plane.axes() {
            let goal = &goals[axis.index()];
            from[axis] = circle_frame(goal) - goal.way + started[axis];
            to[axis] = circle_frame(goal) + self.now.axes[axis.index()].applied;
        }
        (from, to)
    }

    fn written_arc(
        &self,
        goals: &Goals,
        started: &Coordinates,
        [x, y]: [f64; 2],
        same_ends: SameEnds,
    ) -> WrittenArc {
        let plane = self.now.modes.plane;
        let (from, to) = self.written_ends(goals, started);
        let seen = |place: &Coordinates| {
            let [first, second] = plane.of(place);
            [first - x, second - y]
        };
        WrittenArc {
            start: seen(&from),
            end: seen(&to),
            steps: plane.axes().map(|axis| self.scale(axis).step()),
            same_ends,
        }
    }

    /// What the control will find in what was written: radii at both ends, and the angle between them.
    fn check_written(
        &self,
        goals: &Goals,
        started: &Coordinates,
        centre: [f64; 2],
        circle: &Circle,
    ) -> Result<(), Found> {
        let written = self.written_arc(goals, started, centre, SameEnds::FullCircle);
        let [start_mm, end_mm] = written.radii();
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
        written
            .check_sweep(circle.sweep)
            .map_err(|reason| (self.at(), reason))
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
