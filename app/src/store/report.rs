//! What came of loading the settings.

use core::fmt;

use leadscrew::params::ParamError;

use leadscrew::settings::Key;

/// Where the settings come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Source {
    /// Nothing was stored: all defaults.
    #[default]
    Defaults,
    /// From the store.
    Stored,
    /// What is stored is damaged: all defaults. The axis is not to be enabled on them unasked.
    Damaged,
    /// What is stored has a newer format: all defaults. As with damage.
    Newer {
        /// Version of the format.
        version: u16,
    },
}

/// What came of loading the settings; each finding was told while loading.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// Where they come from.
    pub source: Source,
    /// Values taken from the store.
    pub taken: u16,
    /// Values that were not stored: defaults.
    pub missing: u16,
    /// Values that were refused: defaults.
    pub refused: u16,
    /// Values stored that this firmware does not know. They are kept.
    pub unknown: u16,
    /// What is wrong with all of them together: they are not to be used.
    pub invalid: Option<ParamError>,
}

impl Report {
    /// The settings are those that were saved, and may be used as they are.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        self.source == Source::Stored && self.refused == 0 && self.invalid.is_none()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            taken,
            missing,
            refused,
            unknown,
            ..
        } = self;
        match self.source {
            Source::Defaults => f.write_str("nothing is stored: all parameters are defaults")?,
            Source::Stored => write!(
                f,
                "{taken} parameters taken, {missing} not stored and {refused} refused (defaults), {unknown} unknown \
                 (kept)"
            )?,
            Source::Damaged => f.write_str(
                "the stored parameters are damaged, all are defaults: restore a backup before the axis is enabled",
            )?,
            Source::Newer { version } => write!(
                f,
                "the stored parameters have format {version} of a newer firmware, all are defaults: update the \
                 firmware, or erase them"
            )?,
        }
        match &self.invalid {
            None => Ok(()),
            Some(error) => write!(f, "; they cannot be used: {error}"),
        }
    }
}

/// Something about one value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Finding<'s> {
    /// It was not stored.
    Missing {
        /// Its name.
        key: Key,
    },
    /// It is stored, and out of range.
    OutOfRange {
        /// Its name.
        key: Key,
        /// What is stored.
        value: f64,
        /// What may be.
        range: (f64, f64),
        /// What was taken instead.
        default: f64,
    },
    /// It is stored, and none of the words that may be.
    UnknownWord {
        /// Its name.
        key: Key,
        /// What is stored.
        word: &'s str,
        /// What was taken instead.
        default: &'static str,
    },
    /// A word is stored for a number, or a number for a word.
    WrongType {
        /// Its name.
        key: Key,
    },
    /// This firmware knows no such name.
    Unknown {
        /// What is stored.
        name: &'s str,
    },
}

impl fmt::Display for Finding<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { key } => write!(f, "{key} is not stored: its default is taken"),
            Self::OutOfRange {
                key,
                value,
                range: (min, max),
                default,
            } => write!(
                f,
                "{key} = {value} is out of range: allowed {min} to {max}; the default {default} is taken"
            ),
            Self::UnknownWord { key, word, default } => write!(
                f,
                "{key} = {word} is not known; the default {default} is taken"
            ),
            Self::WrongType { key } => write!(
                f,
                "{key} is stored with another type than it has: its default is taken"
            ),
            Self::Unknown { name } => write!(
                f,
                "{name} is not a parameter of this firmware: it is kept and not used"
            ),
        }
    }
}
