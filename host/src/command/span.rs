//! `--from-s` and `--to-s`.

use std::fmt;

use crate::error::CommandError;

/// The span of time that is judged, of what lies after warm-up.
pub(super) struct Span {
    from_s: f64,
    to_s: f64,
}

impl Span {
    /// From and to, s; without them from the start and to the end.
    ///
    /// # Errors
    /// A span that begins before 0 or ends before its beginning.
    pub(super) fn new(from_s: Option<f64>, to_s: Option<f64>) -> Result<Self, CommandError> {
        let (from, to) = (from_s.unwrap_or(0.0), to_s.unwrap_or(f64::INFINITY));
        if from >= 0.0 && from < to {
            Ok(Self {
                from_s: from,
                to_s: to,
            })
        } else {
            Err(CommandError::Usage(format!(
                "--from-s {from} --to-s {to}: the span must begin at 0 or later and end after its beginning"
            )))
        }
    }

    /// True for a tick within.
    pub(super) fn contains(&self, tick: usize, tick_hz: f64) -> bool {
        (self.from_s..=self.to_s).contains(&(tick as f64 / tick_hz))
    }
}

impl fmt::Display for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("after warm-up")?;
        if self.from_s > 0.0 {
            write!(f, ", from {} s", self.from_s)?;
        }
        if self.to_s.is_finite() {
            write!(f, ", to {} s", self.to_s)?;
        }
        Ok(())
    }
}
