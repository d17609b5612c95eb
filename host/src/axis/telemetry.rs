//! Records of ticks as they come, made a recording.

use std::time::Duration;

use leadscrew::scope::Signal;
use leadscrew::telemetry::Record;
use leadscrew_client::{Axis, Recording};

use crate::error::CommandError;

/// Signals of a record, in the order of [`values`].
const SIGNALS: [Signal; 10] = [
    Signal::Count,
    Signal::Position,
    Signal::Velocity,
    Signal::Acceleration,
    Signal::SetpointPosition,
    Signal::SetpointVelocity,
    Signal::SetpointAcceleration,
    Signal::FollowingError,
    Signal::Command,
    Signal::Flags,
];
/// Longest that a record is waited for: the line is quiet then.
const QUIET: Duration = Duration::from_secs(1);
/// Most records of a recording.
const MOST: u32 = 4_000_000;

/// What was recorded, and how much of it did not arrive.
#[derive(Clone, Debug, PartialEq)]
pub struct Streamed {
    /// The records.
    pub recording: Recording,
    /// Records that were lost on the line; they are missing in the recording.
    pub lost: u64,
}

/// Records for so many seconds of the axis's time, a record in every `every` ticks.
///
/// # Errors
/// Too long, a lost axis, no records at all.
pub fn stream(axis: &mut Axis, seconds: f64, every: u16) -> Result<Streamed, CommandError> {
    let scale = axis.scale()?;
    let wanted = (seconds * scale.tick_hz / f64::from(every)).round();
    if !(1.0..=f64::from(MOST)).contains(&wanted) {
        return Err(CommandError::Usage(format!(
            "--seconds {seconds}: {wanted} records; expected 1 to {MOST}, choose another time or --every"
        )));
    }
    let mut recording = Recording::new(scale, &SIGNALS, every);
    axis.subscribe(every)?;
    let mut records = axis.records(QUIET);
    let mut first = None;
    for record in records.by_ref() {
        let record = record?;
        let first = *first.get_or_insert(record.tick);
        let after = record.tick.wrapping_sub(first);
        if f64::from(after) >= wanted * f64::from(every) {
            break;
        }
        recording.push(i64::from(first) + i64::from(after), values(&record));
    }
    axis.subscribe(0)?;
    if recording.is_empty() {
        return Err(CommandError::Data(
            "no record came: take a larger --every, or look at the line".to_owned(),
        ));
    }
    let lost = recording.missing();
    Ok(Streamed { recording, lost })
}

/// The signals of a record, whole.
fn values(record: &Record) -> [i64; 10] {
    // The position is never far from the count.
    let near = record.position >> 16;
    let step = record.count.wrapping_sub(near as u32).cast_signed();
    [
        near + i64::from(step),
        record.position,
        record.velocity.into(),
        record.acceleration.into(),
        record.setpoint_position,
        record.setpoint_velocity.into(),
        record.setpoint_acceleration.into(),
        record.following_error.into(),
        record.command.into(),
        record.flags.into(),
    ]
}
