//! Names of values.

use core::fmt;

/// Name of a value: `section.name`, or `name` alone. Names are added, none is used anew for something else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    /// Its section; empty for what belongs to none.
    pub section: &'static str,
    /// Its name there.
    pub name: &'static str,
}

impl Key {
    /// The name of what belongs to no section.
    #[must_use]
    pub const fn alone(name: &'static str) -> Self {
        Self { section: "", name }
    }

    /// What the name is put together of.
    #[must_use]
    pub const fn parts(self) -> [&'static str; 3] {
        let dot = if self.section.is_empty() { "" } else { "." };
        [self.section, dot, self.name]
    }

    /// True of the whole name, section included.
    #[must_use]
    pub fn is(self, name: &str) -> bool {
        let rest = self.parts().into_iter().try_fold(name, str::strip_prefix);
        rest.is_some_and(str::is_empty)
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.parts().iter().try_for_each(|part| f.write_str(part))
    }
}
