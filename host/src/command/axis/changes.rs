//! Changes of settings, for people and programs.

use serde::Serialize;

use crate::axis::{Change, Setting};
use crate::command::autotune::margins::number;
use crate::report::text_table;

/// A setting that changes.
#[derive(Serialize)]
pub struct Changed {
    name: String,
    unit: &'static str,
    before: Shown,
    after: Shown,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Shown {
    Number(f64),
    Word(&'static str),
}

impl From<Setting> for Shown {
    fn from(setting: Setting) -> Self {
        match setting {
            Setting::Number(value) => Self::Number(value),
            Setting::Word(word) => Self::Word(word),
        }
    }
}

impl From<&Change> for Changed {
    fn from(change: &Change) -> Self {
        Self {
            name: change.name.clone(),
            unit: change.unit,
            before: change.before.into(),
            after: change.after.into(),
        }
    }
}

/// A table of them.
pub fn table(changes: &[Change]) -> String {
    let mut table = text_table(&["parameter", "before", "after", "unit"]);
    let shown = |setting| match setting {
        Setting::Number(value) => number(value),
        Setting::Word(word) => word.to_owned(),
    };
    for change in changes {
        table.add_row([
            change.name.clone(),
            shown(change.before),
            shown(change.after),
            change.unit.to_owned(),
        ]);
    }
    table.trim_fmt()
}
