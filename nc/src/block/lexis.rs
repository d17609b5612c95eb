//! What counts as a word.

use serde::Deserialize;

/// What an O word is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OWords {
    /// The number of the program.
    #[default]
    ProgramNumber,
    /// Subroutines, loops and branches of LinuxCNC.
    Flow,
}

/// What of the text a dialect knows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lexis {
    /// `( )` are comments.
    pub round_comments: bool,
    /// `;` begins a comment.
    pub semicolon_comments: bool,
    /// `[ ]`, `#` and functions are values, `#1 = 2` sets a parameter.
    pub expressions: bool,
    /// Blanks may stand between the digits of a number.
    pub blanks_in_numbers: bool,
    /// What an O word is.
    pub o_words: OWords,
}

impl Lexis {
    /// All that LinuxCNC reads.
    #[must_use]
    pub const fn linuxcnc() -> Self {
        Self {
            round_comments: true,
            semicolon_comments: true,
            expressions: true,
            blanks_in_numbers: true,
            o_words: OWords::Flow,
        }
    }
}
