//! `leadscrew scope`: signals of the axis around the moment that matters.

use std::time::Duration;

use leadscrew_client::Axis;

use super::recording::{check, tell};
use crate::axis::scope::{DEFAULT_SIGNALS, Move, Wanted, record};
use crate::cli::ScopeArgs;
use crate::error::CommandError;
use crate::recorded::{Recorded, Source};

/// Runs the command.
///
/// # Errors
/// What does not fit, a file that cannot be written, the axis.
pub fn run(axis: &mut Axis, args: &ScopeArgs) -> Result<(), CommandError> {
    check(&args.to)?;
    let signals = args.signals.as_ref();
    let wanted = Wanted {
        signals: signals.map_or_else(|| DEFAULT_SIGNALS.to_vec(), |list| list.0.clone()),
        seconds: args.seconds,
        every: args.every,
        trigger: args.trigger,
        before: args.before,
    };
    let motion = args.target.zip(args.feed);
    let motion = motion.map(|(target_mm, feed_mm_per_min)| Move {
        target_mm,
        feed_mm_per_min,
    });
    let patience = Duration::from_secs_f64(args.wait);
    let is_off = motion.is_some() && !axis.status()?.is_enabled;
    if is_off {
        axis.enable()?;
    }
    let recording = record(axis, &wanted, motion, patience)?;
    if is_off {
        axis.disable()?;
    }
    let recorded = Recorded::of(axis, Source::Scope, recording)?;
    tell(&recorded, "Scope", &args.to)
}
