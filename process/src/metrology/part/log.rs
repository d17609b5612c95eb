//! Logs of LinuxCNC: what `(PROBEOPEN file)` writes.
//!
//! A line a touch, nine numbers X Y Z A B C U V W: where the controlled point was when the probe tripped, in the units and the
//! coordinates that the program works in. A touch at exactly the place of the one before writes no line, so that every line is
//! held against its planned place.

use leadscrew_nc::source::{Complaint, number_of};

use super::{Part, Planned, Touches};
use crate::metrology::touch::{Touch, vector3};

/// Numbers of a line.
const NUMBERS: usize = 9;
/// A touch is off its line of approach by no more, mm.
const LARGEST_OFFSET_MM: f64 = 0.5;

/// Reads a log as the program of [`super::program`] makes it: touches in the order of the part's file.
///
/// # Errors
/// Where and what is wrong: a line that is none, one far from the touch that it should be, too few or too many.
pub fn read(text: &str, part: &Part) -> Result<Touches, Complaint> {
    let mut touches: Touches = vec![Vec::new(); part.features.len()];
    let planned = || {
        let features = part.features.iter().enumerate();
        features.flat_map(|(index, feature)| {
            feature.planned.iter().map(move |planned| (index, planned))
        })
    };
    let expected = planned().count();
    let mut order = planned();
    let mut found = 0;
    for (span, line) in lines(text) {
        let centre = place(text, span.start, line)?;
        found += 1;
        let Some((index, planned)) = order.next() else {
            let message = format!(
                "more lines than the {expected} touches of the part: one log holds one run"
            );
            return Err(Complaint::at(text, &span, message));
        };
        let measured = part.probe.surface(centre, planned.normal);
        let mut touch = Touch::at(planned.nominal, planned.normal, measured);
        touch.sigma_mm = part.probe.sigma_mm;
        if let Some(reason) = is_elsewhere(part, planned, &touch) {
            let name = &part.features[index].name;
            let message = format!(
                "touch {found} should be point {} of {name}, {reason}: is a line missing before it, or is the log of another part?",
                planned.point
            );
            return Err(Complaint::at(text, &span, message));
        }
        touches[index].push((planned.point.clone(), touch));
    }
    if let Some((index, planned)) = order.next() {
        let name = &part.features[index].name;
        let message = format!(
            "{found} lines for {expected} touches, point {} of {name} is the next: the program did not run to its end",
            planned.point
        );
        return Err(Complaint::at(text, &(text.len()..text.len()), message));
    }
    Ok(touches)
}

/// Lines with something in them.
fn lines(text: &str) -> impl Iterator<Item = (std::ops::Range<usize>, &str)> {
    let mut from = 0;
    text.split_inclusive('\n').filter_map(move |line| {
        let start = from;
        from += line.len();
        (!line.trim().is_empty()).then(|| (start..start + line.trim_end().len(), line))
    })
}

fn place(text: &str, start: usize, line: &str) -> Result<[f64; 3], Complaint> {
    let mut numbers = Vec::new();
    let mut at = 0;
    for word in line.split_whitespace() {
        at += line[at..].find(word).unwrap_or(0);
        let span = start + at..start + at + word.len();
        at += word.len();
        let number = number_of(word).and_then(|number| {
            let finite = number.is_finite().then_some(number);
            finite.ok_or_else(|| "expected a finite number".to_owned())
        });
        numbers.push(
            number
                .map_err(|expected| Complaint::at(text, &span, format!("`{word}`: {expected}")))?,
        );
    }
    if numbers.len() != NUMBERS {
        let message = format!(
            "{} numbers: expected {NUMBERS}, X Y Z A B C U V W",
            numbers.len()
        );
        return Err(Complaint::at(text, &(start..start), message));
    }
    Ok([numbers[0], numbers[1], numbers[2]])
}

/// Why a touch is not the planned one, if so.
fn is_elsewhere(part: &Part, planned: &Planned, touch: &Touch) -> Option<String> {
    let along = touch.along_normal_mm();
    let off = vector3(touch.measured) - vector3(planned.nominal);
    let aside = (off - vector3(touch.normal) * along).norm();
    let (approach, overtravel) = (part.program.approach_mm, part.program.overtravel_mm);
    if aside > LARGEST_OFFSET_MM {
        return Some(format!("but lies {aside:.3} mm beside it"));
    }
    let within = -overtravel - LARGEST_OFFSET_MM..=approach + LARGEST_OFFSET_MM;
    (!within.contains(&along)).then(|| format!("but lies {along:.3} mm from it along the normal"))
}
