//! The screw error table of a scenario.

use leadscrew_hal_mock::scenario::{Action, Ask, ScrewReading, Timed};
use toml::de::{DeTable, DeValue};

use super::words::{Key, Value, read_all};
use crate::toml_file::Complaint;

const fn error(name: &'static str, what: &'static str) -> Key {
    Key {
        name,
        what,
        value: Value::Number {
            unit: "µm",
            min: -1e6,
            max: 1e6,
        },
        default: None,
    }
}

const POSITION: Key = Key {
    name: "position_mm",
    what: "place from the origin",
    value: Value::Number {
        unit: "mm",
        min: -1e6,
        max: 1e6,
    },
    default: None,
};
const FORWARD: Key = error("forward_um", "carriage less place, coming upward");
const BACKWARD: Key = Key {
    default: Some(f64::NAN),
    ..error("backward_um", "the same coming downward")
};

/// All `[[screw]]`, of a run that does `timeline`.
pub fn read(document: &DeTable<'_>, timeline: &[Timed]) -> Result<Vec<ScrewReading>, Complaint> {
    let Some(value) = document.get("screw") else {
        return Ok(Vec::new());
    };
    let wrong = |place| {
        Complaint::new(
            place,
            "`screw` is a list of points: write [[screw]] with position_mm and forward_um below it, once for each",
        )
    };
    let DeValue::Array(entries) = value.get_ref() else {
        return Err(wrong(value.span()));
    };
    let is_home = |timed: &Timed| matches!(timed.action, Action::Ask(Ask::Home));
    if !timeline.iter().any(is_home) {
        return Err(Complaint::new(
            value.span(),
            "a table of the screw is in use once the axis is homed: add an [[at]] with action = \"home\"",
        ));
    }
    let mut readings: Vec<ScrewReading> = Vec::new();
    for entry in entries.iter() {
        let DeValue::Table(table) = entry.get_ref() else {
            return Err(wrong(entry.span()));
        };
        let keys = [&POSITION, &FORWARD, &BACKWARD];
        let values = read_all(table, &keys, &[], "[[screw]]", entry.span())?;
        let (forward, backward) = (values[1], values[2]);
        readings.push(ScrewReading {
            position_mm: values[0],
            forward_mm: forward / 1000.0,
            backward_mm: if backward.is_nan() { forward } else { backward } / 1000.0,
        });
    }
    Ok(readings)
}
