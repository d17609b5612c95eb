//! Range checks of what a user wrote, with its place in the text.

use std::ops::Range;

use toml::Spanned;

use crate::coordinates::{Axis, Coordinates};
use crate::source::Complaint;

/// Farthest coordinate that is believed, mm or degrees.
pub const FARTHEST: f64 = 1e6;
/// Largest constant part of a correction that is believed, mm or degrees: more is a slip of unit or datum.
pub const LARGEST_K: f64 = 1000.0;

/// A number within bounds, or a complaint that names key, value, unit and allowed range.
///
/// # Errors
/// Where it is not within them; not a number is not.
pub fn within(
    text: &str,
    key: &str,
    value: &Spanned<f64>,
    (low, high): (f64, f64),
    unit: &str,
) -> Result<f64, Complaint> {
    let number = *value.get_ref();
    if (low..=high).contains(&number) {
        return Ok(number);
    }
    Err(Complaint::at(
        text,
        &value.span(),
        format!("{key} = {number} {unit} is out of range: allowed are {low} to {high} {unit}"),
    ))
}

/// The same of a number without a span of its own.
///
/// # Errors
/// As [`within`].
pub fn within_at(
    text: &str,
    span: &Range<usize>,
    key: &str,
    number: f64,
    (low, high): (f64, f64),
    unit: &str,
) -> Result<f64, Complaint> {
    within(
        text,
        key,
        &Spanned::new(span.clone(), number),
        (low, high),
        unit,
    )
}

/// Values of axes, `{ X = 1.0, Z = 2.0 }`; those left out are 0.
pub type ByAxis = std::collections::BTreeMap<Axis, Spanned<f64>>;

/// The coordinates of a table of mm (`rotary` false: linear axes only) or degrees (`rotary` true: A, B, C only).
///
/// # Errors
/// An axis of the wrong kind, or a value beyond `most`.
pub fn coordinates(
    text: &str,
    key: &str,
    values: &ByAxis,
    rotary: bool,
    most: f64,
) -> Result<Coordinates, Complaint> {
    let mut result = Coordinates::ZERO;
    for (axis, value) in values {
        if axis.is_rotary() != rotary {
            return Err(Complaint::at(
                text,
                &value.span(),
                format!(
                    "{axis} is measured in {}: it does not belong in {key}",
                    axis.unit()
                ),
            ));
        }
        let name = format!("{key}: {axis}");
        result[*axis] = within(text, &name, value, (-most, most), axis.unit())?;
    }
    Ok(result)
}

/// The coordinates of `key_mm` and `key_deg` together.
///
/// # Errors
/// As [`coordinates`].
pub fn place(
    text: &str,
    key: &str,
    mm: &ByAxis,
    deg: &ByAxis,
    most: f64,
) -> Result<Coordinates, Complaint> {
    Ok(coordinates(text, &format!("{key}_mm"), mm, false, most)?
        + coordinates(text, &format!("{key}_deg"), deg, true, most)?)
}
