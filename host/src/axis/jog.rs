//! Jogging: a motion that goes on until somebody ends it.

use std::time::Duration;

use leadscrew_client::{Axis, Error, Status};

/// Time between two looks at the axis.
const LOOK: Duration = Duration::from_millis(50);

/// What ended a jog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JogEnd {
    /// The time was over.
    Time,
    /// Somebody pressed Ctrl-C.
    Interrupted,
    /// It came to rest by itself, as at a soft limit.
    Rest,
}

impl JogEnd {
    /// In words.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Time => "the time is over",
            Self::Interrupted => "ended by Ctrl-C",
            Self::Rest => "the axis came to rest by itself, as it does at a soft limit",
        }
    }
}

/// Jogs with a feed in mm/min for a time, or until it is interrupted; the axis stands in the end. `begun` is told
/// once it is under way.
///
/// # Errors
/// Of the order; [`Error::Faulted`]; those of a lost axis.
pub fn jog(
    axis: &mut Axis,
    feed_mm_per_min: f64,
    time: Option<Duration>,
    begun: impl FnOnce(),
) -> Result<(JogEnd, Status), Error> {
    axis.jog(feed_mm_per_min)?;
    begun();
    match watch(axis, time) {
        Ok(JogEnd::Time) => Ok((JogEnd::Time, axis.stop()?)),
        Ok(end) => Ok((end, axis.status()?)),
        // The connection has stopped the axis and waited for its rest.
        Err(Error::Interrupted { stands: true }) => Ok((JogEnd::Interrupted, axis.status()?)),
        Err(error) => Err(error),
    }
}

fn watch(axis: &mut Axis, time: Option<Duration>) -> Result<JogEnd, Error> {
    let begin = axis.connection().now();
    loop {
        let gone = axis.connection().now().saturating_sub(begin);
        let left = time.map(|time| time.saturating_sub(gone));
        if left == Some(Duration::ZERO) {
            return Ok(JogEnd::Time);
        }
        axis.wait(left.map_or(LOOK, |left| left.min(LOOK)))?;
        let status = axis.status()?;
        if status.fault_number != 0 {
            axis.wait_for_rest()?;
            return Err(Error::Faulted(status.fault_number));
        }
        // The order shows a few ticks after it was taken.
        let is_over = axis.connection().now().saturating_sub(begin) >= LOOK;
        if is_over && !status.is_moving && !status.is_held {
            return Ok(JogEnd::Rest);
        }
    }
}
