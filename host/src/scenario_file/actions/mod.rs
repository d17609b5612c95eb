//! The actions of a timeline, by the names that files give them.

mod asked;
mod troubles;

use std::ops::Range;

use leadscrew_hal_mock::scenario::{Action, Ask, Outer, Timed, Trouble};
use toml::de::DeTable;

use super::words::{Key, Value, read_all};
use crate::toml_file::{Complaint, suggestion};

pub use self::asked::ASKED;
pub use self::troubles::TROUBLES;

/// An action: its name, its keys, and what is made of their values.
#[derive(Clone, Copy, Debug)]
pub struct Spec {
    /// Its name.
    pub name: &'static str,
    /// What it does.
    pub what: &'static str,
    /// Its keys, beside those that all have.
    pub keys: &'static [Key],
    make: Make,
}

#[derive(Clone, Copy, Debug)]
enum Make {
    Ask(fn(&[f64]) -> Ask),
    /// Lasts for a time.
    Trouble(fn(&[f64]) -> Trouble),
    /// From outside the axis.
    Outer(fn(&[f64]) -> Outer),
    /// Comes once.
    Event(fn(&[f64]) -> Trouble),
}

impl Spec {
    const fn ask(
        name: &'static str,
        what: &'static str,
        keys: &'static [Key],
        make: fn(&[f64]) -> Ask,
    ) -> Self {
        let make = Make::Ask(make);
        Self {
            name,
            what,
            keys,
            make,
        }
    }

    const fn trouble(
        name: &'static str,
        what: &'static str,
        keys: &'static [Key],
        make: fn(&[f64]) -> Trouble,
    ) -> Self {
        let make = Make::Trouble(make);
        Self {
            name,
            what,
            keys,
            make,
        }
    }

    const fn outer(
        name: &'static str,
        what: &'static str,
        keys: &'static [Key],
        make: fn(&[f64]) -> Outer,
    ) -> Self {
        let make = Make::Outer(make);
        Self {
            name,
            what,
            keys,
            make,
        }
    }

    const fn event(
        name: &'static str,
        what: &'static str,
        keys: &'static [Key],
        make: fn(&[f64]) -> Trouble,
    ) -> Self {
        let make = Make::Event(make);
        Self {
            name,
            what,
            keys,
            make,
        }
    }

    /// True for what lasts for a time.
    #[must_use]
    pub const fn lasts(&self) -> bool {
        matches!(self.make, Make::Trouble(_))
    }
}

const fn number(
    name: &'static str,
    unit: &'static str,
    min: f64,
    max: f64,
    what: &'static str,
) -> Key {
    Key {
        name,
        what,
        value: Value::Number { unit, min, max },
        default: None,
    }
}

const fn whole(name: &'static str, min: u32, max: u32, what: &'static str) -> Key {
    Key {
        name,
        what,
        value: Value::Whole { min, max },
        default: None,
    }
}

impl Key {
    const fn or(self, default: f64) -> Self {
        Self {
            default: Some(default),
            ..self
        }
    }
}

const TIME: Key = number(
    "time_s",
    "s",
    0.0,
    1e5,
    "when, from the start of the run; the nearest tick is the first to see it",
);
/// How long a trouble lasts.
pub const FOR: Key = number(
    "for_s",
    "s",
    0.0,
    1e5,
    "for how long; left out: to the end of the run",
)
.or(f64::INFINITY);

/// All actions.
fn all() -> impl Iterator<Item = &'static Spec> {
    ASKED.iter().chain(TROUBLES)
}

/// Reads one `[[at]]`.
pub(super) fn read(table: &DeTable<'_>, place: Range<usize>) -> Result<Timed, Complaint> {
    let names = || all().map(|spec| spec.name);
    let Some(value) = table.get("action") else {
        let first = names().take(3).collect::<Vec<_>>().join("\", \"");
        return Err(Complaint::new(
            place,
            format!("an [[at]] needs an `action`, such as \"{first}\""),
        ));
    };
    let word = value.get_ref().as_str().unwrap_or_default();
    let Some(spec) = all().find(|spec| spec.name == word) else {
        return Err(Complaint::new(
            value.span(),
            format!("unknown action `{word}`{}", suggestion(word, names())),
        ));
    };
    let keys: Vec<&Key> = [&TIME]
        .into_iter()
        .chain(spec.keys)
        .chain(spec.lasts().then_some(&FOR))
        .collect();
    let of = format!("action \"{}\"", spec.name);
    let values = read_all(table, &keys, &["action"], &of, place)?;
    let own = &values[1..=spec.keys.len()];
    let action = match spec.make {
        Make::Ask(make) => Action::Ask(make(own)),
        Make::Outer(make) => Action::Set(make(own)),
        Make::Trouble(make) => Action::Trouble {
            trouble: make(own),
            for_s: values[values.len() - 1],
        },
        Make::Event(make) => Action::Trouble {
            trouble: make(own),
            for_s: 0.0,
        },
    };
    Ok(Timed {
        at_s: values[0],
        action,
    })
}
