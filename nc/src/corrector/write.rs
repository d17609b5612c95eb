//! Numbers into words, words into blocks.

use std::ops::Range;

use super::refusal::Reason;
use super::state::Modes;
use crate::block::{Number, Sign};
use crate::coordinates::{AXES, Axis};
use crate::dialect::{Dialect, Integers};

/// mm of an inch.
const INCH_MM: f64 = 25.4;

/// How the words of an axis count.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// mm or degrees of a unit.
    unit: f64,
    /// Units of a step.
    increment: f64,
    /// Steps of a unit, where that is a whole number.
    per_unit: Option<f64>,
    /// mm or degrees of a step.
    step: f64,
    /// Decimals of a step.
    decimals: u8,
    /// Numbers without a point are steps.
    integers_are_steps: bool,
    /// Degrees.
    pub rotary: bool,
}

impl Scale {
    pub fn of(dialect: &Dialect, modes: &Modes, axis: Axis) -> Self {
        let mut scale = Self::of_centre(dialect, modes);
        if axis.is_rotary() {
            scale = Self::new(dialect, 1.0, dialect.numbers().increment_degrees);
            scale.rotary = true;
        } else if modes.diameter && dialect.diameter() == Some(axis) {
            scale.unit /= 2.0;
            scale.step /= 2.0;
        }
        scale
    }

    /// Of I, J, K and R, which are radii on a lathe too.
    pub fn of_centre(dialect: &Dialect, modes: &Modes) -> Self {
        let numbers = dialect.numbers();
        match (modes.inches, numbers.increment_inch) {
            (true, Some(increment)) => Self::new(dialect, INCH_MM, increment),
            _ => Self::new(dialect, 1.0, numbers.increment_mm),
        }
    }

    fn new(dialect: &Dialect, unit: f64, increment: f64) -> Self {
        let per_unit = (1.0 / increment).round();
        Self {
            unit,
            increment,
            per_unit: ((per_unit * increment - 1.0).abs() < 1e-9).then_some(per_unit),
            step: unit * increment,
            decimals: (-increment.log10()).round().clamp(0.0, 9.0) as u8,
            integers_are_steps: dialect.numbers().integers == Integers::Increments,
            rotary: false,
        }
    }

    /// mm or degrees of a step.
    pub const fn step(&self) -> f64 {
        self.step
    }

    /// What a number says, mm or degrees.
    pub fn read(&self, number: Number) -> f64 {
        if self.counts_steps(number) {
            number.value() * self.increment * self.unit
        } else {
            number.value() * self.unit
        }
    }

    fn counts_steps(&self, style: Number) -> bool {
        self.integers_are_steps && !style.has_point()
    }

    /// True where a number says a value to half a step.
    pub fn says(&self, value: f64, wanted: f64) -> bool {
        (value - wanted).abs() <= self.step() * (0.5 + 1e-6)
    }

    /// The steps nearest to a value, and their value.
    pub fn nearest(&self, wanted: f64, letter: u8) -> Result<(i64, f64), Reason> {
        let steps = (wanted / self.step()).round();
        if steps.is_nan() || steps.abs() > 1e15 {
            return Err(Reason::Overflow {
                letter: char::from(letter),
                steps: steps as i64,
                digits: 15,
            });
        }
        let units = match self.per_unit {
            Some(per_unit) => steps / per_unit,
            None => steps * self.increment,
        };
        Ok((steps as i64, units * self.unit))
    }
}

/// The scales of all axes in the modes in force.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scales {
    axes: [Scale; AXES],
    /// What they were made for: inches, diameter.
    modes: (bool, bool),
}

impl Scales {
    pub fn new(dialect: &Dialect, modes: &Modes) -> Self {
        Self {
            axes: Axis::ALL.map(|axis| Scale::of(dialect, modes, axis)),
            modes: (modes.inches, modes.diameter),
        }
    }

    /// Makes them anew where the modes have changed.
    pub fn follow(&mut self, dialect: &Dialect, modes: &Modes) {
        if self.modes != (modes.inches, modes.diameter) {
            *self = Self::new(dialect, modes);
        }
    }

    pub const fn of(&self, axis: Axis) -> &Scale {
        &self.axes[axis.index()]
    }
}

/// Changes of a block. Kept from block to block.
#[derive(Debug, Default)]
pub(super) struct Edits {
    text: Vec<u8>,
    list: Vec<(Range<usize>, Range<usize>)>,
}

impl Edits {
    pub fn clear(&mut self) {
        self.text.clear();
        self.list.clear();
    }

    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Replaces bytes of the block by what is written; an empty range inserts.
    pub fn put<E>(
        &mut self,
        at: Range<usize>,
        write: impl FnOnce(&mut Vec<u8>) -> Result<(), E>,
    ) -> Result<(), E> {
        let start = self.text.len();
        write(&mut self.text)?;
        self.list.push((at, start..self.text.len()));
        Ok(())
    }

    /// The block with its changes.
    pub fn apply(&mut self, block: &[u8], out: &mut Vec<u8>) {
        // Stable: what is inserted at one place stays in its order.
        self.list.sort_by_key(|(at, _)| (at.start, at.end));
        let mut copied = 0;
        for (at, text) in &self.list {
            out.extend_from_slice(&block[copied..at.start]);
            out.extend_from_slice(&self.text[text.clone()]);
            copied = at.end;
        }
        out.extend_from_slice(&block[copied..]);
    }
}

/// Writes a number of steps in a style; refuses what does not fit.
pub(super) fn number(
    dialect: &Dialect,
    scale: &Scale,
    style: Number,
    letter: u8,
    steps: i64,
    out: &mut Vec<u8>,
) -> Result<(), Reason> {
    let (mut signed, mut style) = (false, style);
    if let Some(field) = dialect.field(letter) {
        signed = field.signed;
        style = style.with_width(field.digits);
        if Number::digits_of(steps) > u32::from(field.digits) {
            return Err(Reason::Overflow {
                letter: char::from(letter),
                steps,
                digits: field.digits,
            });
        }
    }
    let decimals = if scale.counts_steps(style) {
        0
    } else {
        scale.decimals
    };
    style.write_like(steps, decimals, signed, out);
    Ok(())
}

/// The style of numbers of a letter where the block has none to imitate.
pub(super) fn default_style(dialect: &Dialect, letter: u8) -> Number {
    if let Some(field) = dialect.field(letter) {
        let sign = if field.signed { Sign::Plus } else { Sign::None };
        return Number::style(sign, field.digits, 0, false);
    }
    let numbers = dialect.numbers();
    Number::style(
        Sign::None,
        1,
        0,
        numbers.point && numbers.integers == Integers::Increments,
    )
}
