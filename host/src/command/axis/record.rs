//! `leadscrew record`: records of telemetry into a file.

use leadscrew_client::Axis;

use super::recording::{check, tell};
use crate::axis::telemetry::stream;
use crate::cli::RecordArgs;
use crate::error::CommandError;
use crate::recorded::{Recorded, Source};

/// Runs the command.
///
/// # Errors
/// No records, a file that cannot be written, the axis.
pub fn run(axis: &mut Axis, args: &RecordArgs) -> Result<(), CommandError> {
    check(&args.to)?;
    let streamed = stream(axis, args.seconds, args.every)?;
    let recorded = Recorded::of(axis, Source::Telemetry, streamed.recording)?;
    tell(&recorded, "Telemetry", &args.to)
}
