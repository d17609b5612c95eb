//! Arcs as words: the ends, and I, J, K or R with them.

use std::f64::consts::TAU;

use super::super::Task;
use super::super::instruction::Found;
use super::super::places::Goals;
use super::super::write::default_style;
use super::programmed::{Form, LETTERS};
use super::{Circle, circle_frame};
use crate::block::Number;
use crate::coordinates::{Axis, AxisSet, Coordinates};
use crate::terms::ROUNDING;

impl Task<'_> {
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

    fn centre_style(&self, letter: u8) -> Number {
        let other = self.said.centre.iter().flatten().next();
        let style = other.and_then(|word| self.block.words[*word].number());
        style.map_or_else(
            || default_style(&self.known.dialect, letter),
            |style| Number::style(style.sign_shown(), 1, style.decimals(), style.has_point()),
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
}
