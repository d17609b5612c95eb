//! What a logic analyser saw of an encoder: the levels of A, B and the index Z, and the instants at
//! which they changed.
//!
//! ```text
//! file ─► detect ─┬─► vcd ────────┐
//!                 ├─► sigrok_csv ─┼─► channels (which are A, B, Z) ─► timeline ─► Recording
//!                 └─► saleae_csv ─┘
//! ```
//!
//! Three formats are read, told apart by content and never by the file's name:
//!
//! | format | written by | time |
//! |---|---|---|
//! | VCD | sigrok, PulseView, simulators | its `$timescale` |
//! | sigrok CSV | `sigrok-cli -O csv`, PulseView | one row a sample, rate from `; Samplerate:` or given |
//! | Saleae CSV | Logic 2, "Export raw data" | a column in seconds, one row a change |
//!
//! Times stay integers from the file to the caller; none passes through a floating-point number.
//!
//! Levels that are unknown (`x`, `z` in VCD, `X` in Saleae's CSV) are treated alike everywhere:
//! before a channel's first known level that level is assumed from the start; unknown until the end
//! means that the recording ends there; anything else is a gap, across which nothing can be
//! counted, and an error.

mod channels;
mod decimal;
mod detect;
mod error;
mod lines;
mod saleae_csv;
mod sigrok_csv;
mod timeline;
mod vcd;
mod write;

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

pub use channels::{ChannelSelection, Role};
pub use error::{Problem, RecordingError};

use detect::Format;

/// A fill takes this many bytes: captures are read front to back and may be gigabytes.
const READ_BUFFER_BYTES: usize = 1 << 18;

/// A capture of A, B and Z. Times are integers: ticks of `clock_hz` since the first timestamp.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recording {
    /// Resolution of the timestamps, in hertz, 1 to 10^15 (a timescale of 1 us is 1 000 000). It
    /// says how times are written, not how fast the analyser sampled.
    pub clock_hz: u64,
    /// From the first timestamp to the end of the capture, in clock ticks. Timestamps after the
    /// last change count; the last sample of a sigrok CSV lasts one sample period.
    pub duration: u64,
    /// Levels at the first timestamp.
    pub initial: Levels,
    /// Changes in strictly increasing time, each later than 0 and at most `duration`, each
    /// different from the levels before it. Channels that change at one timestamp are one change.
    pub changes: Vec<Change>,
}

/// Levels of the three channels; Z is low throughout where none was asked for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Levels {
    /// Channel A is high.
    pub a: bool,
    /// Channel B is high.
    pub b: bool,
    /// The index channel is high.
    pub z: bool,
}

/// The levels from an instant on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Change {
    /// Clock ticks since the first timestamp.
    pub time: u64,
    /// Levels of all channels from this time on.
    pub levels: Levels,
}

/// Reads a capture, whichever of the known formats it is in.
///
/// `samplerate_hz` is for a sigrok CSV that lost its comments; it must agree with the file's own
/// rate where there is one. Formats that carry times leave it unused.
///
/// # Errors
///
/// The file cannot be read, is in none of the formats, breaks its format, or lacks the channels;
/// the error names the file, the line where there is one, what was expected and what to do.
pub fn read(
    path: &Path,
    channels: &ChannelSelection,
    samplerate_hz: Option<u64>,
) -> Result<Recording, RecordingError> {
    read_located(path, channels, samplerate_hz).map_err(|located| located.in_file(path))
}

fn read_located(
    path: &Path,
    channels: &ChannelSelection,
    samplerate_hz: Option<u64>,
) -> Result<Recording, error::Located> {
    let file = File::open(path).map_err(Problem::Unreadable)?;
    let reader = BufReader::with_capacity(READ_BUFFER_BYTES, file);
    let (format, input) = detect::detect(reader)?;
    match format {
        Format::Vcd => vcd::read(input, channels),
        Format::SigrokCsv => sigrok_csv::read(input, channels, samplerate_hz),
        Format::SaleaeCsv => saleae_csv::read(input, channels),
    }
}
