//! Why no filter was chosen.

use core::fmt;

use leadscrew::units::RangeError;

/// The part of the input's path that edges are too fast for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bottleneck {
    /// The encoder.
    Encoder,
    /// The line receiver.
    Receiver,
    /// The timer's filter, the shortest there is.
    Filter,
}

/// Why no filter was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterError {
    /// A frequency that no encoder, receiver or timer has.
    Range(RangeError),
    /// The feed makes edges too fast.
    TooFast {
        /// For this part.
        part: Bottleneck,
        /// Frequency of a channel at the feed, Hz.
        line_hz: f64,
        /// What the part passes, Hz.
        limit_hz: f64,
        /// The feed, mm/min.
        feed_mm_per_min: f64,
    },
}

impl From<RangeError> for FilterError {
    fn from(error: RangeError) -> Self {
        Self::Range(error)
    }
}

impl fmt::Display for FilterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (part, line_hz, limit_hz, feed) = match self {
            Self::Range(error) => return error.fmt(f),
            Self::TooFast {
                part,
                line_hz,
                limit_hz,
                feed_mm_per_min,
            } => (part, line_hz, limit_hz, feed_mm_per_min),
        };
        let part = match part {
            Bottleneck::Encoder => "the encoder gives",
            Bottleneck::Receiver => "the line receiver passes",
            Bottleneck::Filter => "the input filter passes",
        };
        write!(
            f,
            "{feed} mm/min are {line_hz:.0} Hz on each channel of the encoder, {part} {limit_hz:.0} Hz: allowed are \
             {:.1} mm/min at full command",
            feed * limit_hz / line_hz
        )
    }
}

impl core::error::Error for FilterError {}
