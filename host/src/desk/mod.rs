//! A recording of an axis at the desk: what the core makes of it again.
//!
//! | what | signals that it needs |
//! | --- | --- |
//! | estimators on the counts | `count` |
//! | beside what the axis estimated | `velocity` |
//! | control law | `following_error`, `velocity`, `acceleration`, `setpoint_velocity`, `setpoint_acceleration`, `command`, `flags` |
//! | monitors of the supervisor | `count`, `following_error`, `velocity`, `setpoint_velocity`, `command`, `flags` |
//!
//! All of it needs every tick, none missing. What a recording does not have is told, not guessed: edge times, the index, the
//! drive's lines, and what went on before its first sample.

mod estimators;
mod faults;
mod law;

use leadscrew::estimator::EstimatorConfig;
use leadscrew::params::AxisConfig;
use leadscrew::scope::Signal;
use leadscrew::settings::Settings;
use leadscrew::supervisor;

pub use estimators::{Compared, estimators};
pub use faults::{Derived, Faults, faults};
pub use law::{Law, law};

use crate::recorded::Recorded;

/// Bits of the flags of a record.
const ENABLED: i64 = 1;
const HIGH: i64 = 1 << 1;
const LOW: i64 = 1 << 2;
const SLEW: i64 = 1 << 3;
const MOVING: i64 = 1 << 4;

/// Why a part of a replay cannot be had.
pub type Lacking = String;

/// A recording that is replayed.
pub struct Desk<'a> {
    recorded: &'a Recorded,
    config: AxisConfig,
    monitors: supervisor::Config,
    is_every_tick: bool,
}

impl<'a> Desk<'a> {
    /// The recording on a core that is set as the axis was.
    ///
    /// # Errors
    /// Its parameters make no axis: a sentence.
    pub fn new(recorded: &'a Recorded) -> Result<Self, String> {
        let default = EstimatorConfig::by_name("exponential")
            .ok()
            .flatten()
            .ok_or("there is no estimator to begin with")?;
        let mut settings = recorded.header.settings(Settings::new(default));
        let config = settings
            .validate()
            .map_err(|error| format!("the parameters of the recording make no axis: {error}"))?;
        // Indexes are not recorded: they are none to wait for.
        settings.axis.motion.counts_per_revolution = 0.0;
        let without_index = settings
            .validate()
            .map_err(|error| format!("the parameters of the recording make no axis: {error}"))?;
        let recording = &recorded.recording;
        Ok(Self {
            recorded,
            config,
            monitors: without_index.supervisor,
            is_every_tick: recording.every == 1 && recording.missing() == 0 && !recording.is_torn,
        })
    }

    /// The bits of signals that are all needed.
    fn need<const N: usize>(&self, signals: [Signal; N]) -> Result<[&'a [i64]; N], Lacking> {
        let recording = &self.recorded.recording;
        let lacking: Vec<_> = signals
            .iter()
            .filter(|signal| !recording.signals.contains(signal))
            .map(|signal| signal.name())
            .collect();
        if !lacking.is_empty() {
            return Err(format!(
                "needs {}: record with `--signals replay`",
                lacking.join(", ")
            ));
        }
        if !self.is_every_tick {
            return Err("needs every tick, none missing: record with `--every 1`".to_owned());
        }
        Ok(signals.map(|signal| recording.bits(signal).unwrap_or_default()))
    }

    /// True if the loop was closed in the first sample: what it had added up until then is not known.
    fn begins_in_loop(flags: &[i64]) -> bool {
        flags.first().is_some_and(|flags| is_in_loop(*flags))
    }
}

/// Number of the state in the flags.
const fn state_of(flags: i64) -> u8 {
    (flags >> 8) as u8
}

/// Number of the fault in the flags, 0 for none.
const fn fault_of(flags: i64) -> u8 {
    (flags >> 16) as u8
}

/// Ready, moving or in a controlled stop.
const fn is_in_loop(flags: i64) -> bool {
    flags & ENABLED != 0 && matches!(state_of(flags), 2..=4)
}
