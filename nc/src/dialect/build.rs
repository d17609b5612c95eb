//! A dialect out of its file, checked.

use std::fmt;
use std::ops::Range;

use toml::Spanned;

use super::{CODES, Code, Cycle, Dialect, Letter, file};
use crate::block::Number;
use crate::coordinates::{Axis, AxisSet};
use crate::source::Complaint;

/// A code in a file: `G38.2`.
struct Name {
    letter: u8,
    tenths: usize,
}

pub(super) struct Builder<'a> {
    text: &'a str,
    file: file::File,
    dialect: Dialect,
}

impl<'a> Builder<'a> {
    pub(super) fn new(text: &'a str, file: file::File) -> Result<Self, Complaint> {
        let mut dialect = Dialect {
            name: file.name.clone(),
            description: file.description.clone(),
            lexis: file.text,
            numbers: file.numbers,
            letters: [Letter::Unknown; 128],
            fields: [None; 128],
            g: vec![None; CODES],
            m: vec![None; CODES],
            cycles: Vec::new(),
            refused: Vec::new(),
            axes: AxisSet::NONE,
            diameter: None,
            diameter_at_start: file.axes.diameter_at_start,
            start: Vec::new(),
            set_data: file.set_data.clone(),
            work_offsets: Vec::new(),
            local_is_shift: file.axes.local_is_shift,
            tools: file.tools.selection,
            offsets_stand_still: file.tools.offsets_stand_still,
            length_of_tool_in_use: file.tools.length_of_tool_in_use,
        };
        dialect.letters[usize::from(b'G')] = Letter::G;
        dialect.letters[usize::from(b'M')] = Letter::M;
        dialect.letters[usize::from(b'N')] = Letter::Label;
        dialect.letters[usize::from(b'O')] = Letter::Label;
        Ok(Self {
            text,
            file,
            dialect,
        })
    }

    pub(super) fn build(mut self) -> Result<Dialect, Complaint> {
        self.numbers()?;
        self.letters()?;
        self.fields()?;
        self.codes()?;
        self.start()?;
        Ok(self.dialect)
    }

    fn complain<T>(&self, at: Range<usize>, message: impl fmt::Display) -> Result<T, Complaint> {
        Err(Complaint::at(self.text, &at, message.to_string()))
    }

    fn numbers(&self) -> Result<(), Complaint> {
        let numbers = self.file.numbers;
        let steps = [
            ("increment_mm", Some(numbers.increment_mm)),
            ("increment_inch", numbers.increment_inch),
            ("increment_degrees", Some(numbers.increment_degrees)),
        ];
        let at = self.text.find("[numbers]").unwrap_or(0);
        for (key, step) in steps {
            let Some(step) = step else { continue };
            if !(step.is_finite() && (1e-9..=1.0).contains(&step)) {
                return self.complain(
                    at..at,
                    format_args!("numbers.{key} is {step}: 1e-9 to 1 is allowed"),
                );
            }
            let power = 10_f64.powf(step.log10().round());
            if numbers.point && (step / power - 1.0).abs() > 1e-9 {
                return self.complain(
                    at..at,
                    format_args!(
                        "numbers.{key} is {step}: where numbers have a point it is a power of ten"
                    ),
                );
            }
        }
        Ok(())
    }

    fn letters(&mut self) -> Result<(), Complaint> {
        let known = self.file.axes.known.clone();
        for axis in self.axes_of(&known)?.iter() {
            self.dialect.axes = self.dialect.axes.with(axis);
            self.letter(axis.letter(), Letter::Axis(axis), &known)?;
        }
        for (letter, axis) in self.file.axes.incremental.clone() {
            let axis = self.axis_of(&axis)?;
            let mut letters = letter.get_ref().chars();
            let (Some(one), None) = (letters.next(), letters.next()) else {
                return self.complain(letter.span(), "one letter is expected");
            };
            self.letter(one, Letter::Way(axis), &letter)?;
        }
        if let Some(axis) = self.file.axes.diameter.clone() {
            self.dialect.diameter = Some(self.axis_of(&axis)?);
        }
        let others = self.file.letters.clone();
        for letter in others.get_ref().chars() {
            let meaning = match letter {
                'I' => Letter::Centre(Axis::X),
                'J' => Letter::Centre(Axis::Y),
                'K' => Letter::Centre(Axis::Z),
                _ => Letter::Parameter,
            };
            self.letter(letter, meaning, &others)?;
        }
        Ok(())
    }

    fn letter(
        &mut self,
        letter: char,
        meaning: Letter,
        at: &Spanned<String>,
    ) -> Result<(), Complaint> {
        let upper = letter.is_ascii_uppercase() || matches!(letter, '$');
        if !upper {
            return self.complain(at.span(), format_args!("`{letter}` is no capital letter"));
        }
        let place = &mut self.dialect.letters[letter as usize];
        if *place != Letter::Unknown {
            return self.complain(
                at.span(),
                format_args!("the letter `{letter}` is there twice"),
            );
        }
        *place = meaning;
        Ok(())
    }

    fn axes_of(&self, letters: &Spanned<String>) -> Result<AxisSet, Complaint> {
        let mut axes = AxisSet::NONE;
        for letter in letters.get_ref().chars() {
            let Some(axis) = Axis::from_letter(letter).filter(|_| letter.is_ascii_uppercase())
            else {
                return self.complain(
                    letters.span(),
                    format_args!("`{letter}` is no axis: X, Y, Z, A, B, C, U, V or W"),
                );
            };
            if axes.contains(axis) {
                return self.complain(
                    letters.span(),
                    format_args!("the letter `{letter}` is there twice"),
                );
            }
            axes = axes.with(axis);
        }
        Ok(axes)
    }

    fn axis_of(&self, letter: &Spanned<String>) -> Result<Axis, Complaint> {
        let axes = self.axes_of(letter)?;
        match axes.iter().next() {
            Some(axis) if letter.get_ref().len() == 1 && self.dialect.axes.contains(axis) => {
                Ok(axis)
            }
            _ => self.complain(
                letter.span(),
                format_args!("one of the axes `{}` is expected", self.dialect.axes),
            ),
        }
    }

    fn fields(&mut self) -> Result<(), Complaint> {
        for (letter, field) in std::mem::take(&mut self.file.fields) {
            let place = match letter.get_ref().as_bytes() {
                [byte] if self.dialect.letter(*byte) != Letter::Unknown => usize::from(*byte),
                _ => return self.complain(letter.span(), "a letter of the dialect is expected"),
            };
            if !(1..=15).contains(&field.digits) {
                return self.complain(
                    letter.span(),
                    format_args!("{} digits: 1 to 15 are allowed", field.digits),
                );
            }
            self.dialect.fields[place] = Some(field);
        }
        Ok(())
    }

    fn codes(&mut self) -> Result<(), Complaint> {
        for (meaning, names) in std::mem::take(&mut self.file.codes) {
            self.assign(&names, Code::Of(meaning))?;
        }
        for name in std::mem::take(&mut self.file.work_offsets) {
            let tenths = self.name(&name)?.tenths as u16;
            self.dialect.work_offsets.push(tenths);
            self.assign(&[name], Code::WorkOffset(tenths))?;
        }
        for cycle in std::mem::take(&mut self.file.cycle) {
            let number = self.dialect.cycles.len() as u8;
            let targets = self.axes_of(&cycle.targets)?;
            self.dialect.cycles.push(Cycle {
                targets,
                end: cycle.end,
                modal: cycle.modal,
                thread: cycle.thread,
            });
            self.assign(&cycle.codes, Code::Cycle(number))?;
        }
        for (why, names) in std::mem::take(&mut self.file.refused) {
            let number = self.dialect.refused.len() as u8;
            self.dialect.refused.push(why);
            self.assign(&names, Code::Refused(number))?;
        }
        Ok(())
    }

    fn assign(&mut self, names: &[Spanned<String>], code: Code) -> Result<(), Complaint> {
        for spanned in names {
            let name = self.name(spanned)?;
            let table = if name.letter == b'G' {
                &mut self.dialect.g
            } else {
                &mut self.dialect.m
            };
            if table[name.tenths].replace(code).is_some() {
                return self.complain(
                    spanned.span(),
                    format_args!("{} is there twice", spanned.get_ref()),
                );
            }
        }
        Ok(())
    }

    fn name(&self, name: &Spanned<String>) -> Result<Name, Complaint> {
        let expected = "a code is expected, like \"G38.2\" or \"M6\"";
        let (letter, number) = match name.get_ref().as_bytes() {
            [letter @ (b'G' | b'M'), number @ ..] => (*letter, number),
            _ => return self.complain(name.span(), expected),
        };
        let tenths = Number::read(number, false)
            .ok()
            .filter(|(_, len)| *len == number.len())
            .and_then(|(number, _)| number.tenths())
            .and_then(|tenths| usize::try_from(tenths).ok())
            .filter(|tenths| *tenths < CODES);
        match tenths {
            Some(tenths) => Ok(Name { letter, tenths }),
            None => self.complain(name.span(), expected),
        }
    }

    fn start(&mut self) -> Result<(), Complaint> {
        for name in std::mem::take(&mut self.file.start) {
            let Name { letter, tenths } = self.name(&name)?;
            let table = if letter == b'G' {
                &self.dialect.g
            } else {
                &self.dialect.m
            };
            match table[tenths] {
                Some(code) => self.dialect.start.push(code),
                None => {
                    return self.complain(
                        name.span(),
                        format_args!("{} has no meaning in this dialect", name.get_ref()),
                    );
                }
            }
        }
        Ok(())
    }
}
