//! What can be wrong with a capture, said so that the person at the machine can put it right.

use std::io;
use std::path::{Path, PathBuf};

use super::Role;

/// A capture that could not be read: which file, where in it, and what is wrong.
#[derive(Debug, thiserror::Error)]
#[error("{}{problem}", place(.path, *.line))]
pub struct RecordingError {
    /// The file as it was named by the caller.
    pub path: PathBuf,
    /// Line in the file, from 1, where the problem has one.
    pub line: Option<u64>,
    /// What is wrong, what was expected, and what to do.
    pub problem: Problem,
}

fn place(path: &Path, line: Option<u64>) -> String {
    match line {
        Some(line) => format!("{}: line {line}: ", path.display()),
        None => format!("{}: ", path.display()),
    }
}

/// What is wrong with a capture. The texts do not repeat the file or the line.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// The operating system refused.
    #[error("cannot be read ({0}): check the path and its permissions")]
    Unreadable(io::Error),

    /// No line with anything on it.
    #[error("is empty: expected {KNOWN_FORMATS}")]
    Empty,

    /// Bytes that are no text.
    #[error("is not UTF-8 text: export the capture again, or save the file as UTF-8")]
    NotUtf8,

    /// A container that holds a capture but is no export of it.
    #[error("is {container}, not an export of it: {advice}")]
    NotExported {
        /// What the file is.
        container: &'static str,
        /// How to get an export.
        advice: &'static str,
    },

    /// Text in none of the formats.
    #[error("starts with `{found}`: expected {KNOWN_FORMATS}")]
    UnknownFormat {
        /// The first line with anything on it, shortened.
        found: String,
    },

    /// Fewer than two one-bit signals.
    #[error(
        "expected two one-bit signals for A and B, found {found}: capture both channels of the \
         encoder and export them together"
    )]
    TooFewChannels {
        /// The signals that are there, or "none".
        found: String,
    },

    /// No channel of this name or index.
    #[error(
        "has no channel `{asked}` for {role}: expected a name or an index out of {available}; \
         choose with {}", .role.flag()
    )]
    UnknownChannel {
        /// The channel that was being chosen.
        role: Role,
        /// As asked for.
        asked: String,
        /// What the file offers.
        available: String,
    },

    /// A name that several channels bear.
    #[error(
        "has several channels `{asked}` for {role}: expected one of {candidates}; choose with {} \
         and a full path or an index", .role.flag()
    )]
    AmbiguousChannel {
        /// The channel that was being chosen.
        role: Role,
        /// As asked for.
        asked: String,
        /// The channels of this name.
        candidates: String,
    },

    /// A channel that is not a logic level.
    #[error(
        "offers `{asked}` for {role}, which {obstacle}: expected a one-bit signal, out of \
         {available}; choose with {}", .role.flag()
    )]
    NotOneBit {
        /// The channel that was being chosen.
        role: Role,
        /// As asked for.
        asked: String,
        /// Why it will not do.
        obstacle: String,
        /// What the file offers.
        available: String,
    },

    /// One channel for two purposes.
    #[error(
        "{first} and {second} are both the channel `{name}`: expected two different channels; give \
         both {} and {}", .first.flag(), .second.flag()
    )]
    SameChannel {
        /// One of the two.
        first: Role,
        /// The other.
        second: Role,
        /// The channel's name in the file.
        name: String,
    },

    /// The VCD syntax is broken.
    #[error("is not valid VCD here ({what}): {advice}")]
    Vcd {
        /// What the parser says.
        what: String,
        /// What to do.
        advice: &'static str,
    },

    /// A VCD without a usable timescale.
    #[error(
        "has {found}: expected a line such as `$timescale 1 us $end` before `$enddefinitions`; \
         export the capture again or add it"
    )]
    Timescale {
        /// What is there instead.
        found: &'static str,
    },

    /// Time runs backwards.
    #[error(
        "time {found} comes after {previous}: expected times that never decrease; the file is \
         damaged or joined from several captures, export it again"
    )]
    Backwards {
        /// The time before, as in the file.
        previous: String,
        /// The offending time, as in the file.
        found: String,
    },

    /// More clock ticks than 64 bits hold.
    #[error("the capture is longer than 2^64 ticks of its time resolution: export a shorter range")]
    TooLong,

    /// Header only.
    #[error("has no samples: expected levels of A and B after the header; capture again")]
    NoSamples,

    /// A channel without a single level.
    #[error(
        "never says whether {role} is 0 or 1: choose another channel with {}", .role.flag()
    )]
    NeverKnown {
        /// The channel.
        role: Role,
    },

    /// Levels missing in the middle.
    #[error(
        "the level of {role} is unknown from here, and the recording goes on after that: counts \
         cannot be carried across a gap; export the range before it or after it"
    )]
    Gap {
        /// The channel.
        role: Role,
    },

    /// A row that does not fit the format.
    #[error("expected {expected}, found `{found}`: {advice}")]
    BrokenRow {
        /// What should be here.
        expected: String,
        /// The row, shortened.
        found: String,
        /// What to do.
        advice: &'static str,
    },

    /// A sigrok CSV that does not say how fast it was sampled.
    #[error(
        "does not say its sample rate: expected a comment such as `; Samplerate: 1 MHz`; pass \
         --samplerate with the rate in hertz"
    )]
    NoSamplerate,

    /// A sample rate of zero from the caller.
    #[error("cannot be read at a sample rate of 0 Hz: pass --samplerate with the rate in hertz")]
    ZeroSamplerate,

    /// The file and the caller disagree on the rate.
    #[error(
        "says it was sampled at {in_file_hz} Hz, but --samplerate says {given_hz} Hz: leave \
         --samplerate out"
    )]
    SamplerateConflict {
        /// The rate in the file.
        in_file_hz: u64,
        /// The rate of the caller.
        given_hz: u64,
    },
}

/// The list that every "what is this file" error ends with.
const KNOWN_FORMATS: &str = "a capture of A and B as VCD (starts with `$`), as sigrok CSV (starts \
    with `;` or with rows of 0 and 1) or as Saleae Logic 2 CSV (starts with `Time [s],`)";

impl Problem {
    /// The problem at a line of the file, counted from 1.
    pub(super) fn at(self, line: u64) -> Located {
        Located {
            line: Some(line),
            problem: self,
        }
    }
}

/// A problem before the reader's caller adds the file.
#[derive(Debug)]
pub(super) struct Located {
    line: Option<u64>,
    problem: Problem,
}

impl Located {
    pub(super) fn in_file(self, path: &Path) -> RecordingError {
        RecordingError {
            path: path.to_owned(),
            line: self.line,
            problem: self.problem,
        }
    }
}

impl From<Problem> for Located {
    fn from(problem: Problem) -> Self {
        Located {
            line: None,
            problem,
        }
    }
}

/// Text from a file made fit for a one-line message: shortened, control characters escaped.
pub(super) fn excerpt(bytes: &[u8]) -> String {
    const LONGEST: usize = 60;
    let text = String::from_utf8_lossy(bytes);
    let mut characters = text.trim().chars();
    let mut short: String = characters
        .by_ref()
        .take(LONGEST)
        .flat_map(char::escape_debug)
        .collect();
    if characters.next().is_some() {
        short.push('…');
    }
    short
}
