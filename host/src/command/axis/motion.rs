//! `enable`, `disable`, `home`, `move`, `jog`, `hold`, `resume`, `stop`, `override`, `restart`: orders, and how the axis
//! stands after them.

use std::io::Write as _;
use std::time::Duration;

use leadscrew_client::{Axis, Status};

use super::status::Report;
use crate::axis::jog as jogging;
use crate::axis::values::named_request;
use crate::cli::{JogArgs, JsonArgs, MoveArgs, OverrideArgs};
use crate::command::{print, print_json};
use crate::error::CommandError;

/// Longest time of a jog, s.
const LONGEST_S: f64 = 86_400.0;
/// Time in which an order shows that is not waited for.
const SHOWS: Duration = Duration::from_millis(50);

fn tell(status: &Status, args: &JsonArgs) -> Result<(), CommandError> {
    let report = Report::of(status);
    if args.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

/// Waits until an order shows, and tells.
fn tell_soon(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    axis.wait(SHOWS)?;
    tell(&axis.status()?, args)
}

/// `leadscrew enable`.
///
/// # Errors
/// The axis is lost, or refuses.
pub fn enable(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    let status = axis
        .enable()
        .map_err(|error| named_request(error, "Enabling the axis"))?;
    tell(&status, args)
}

/// `leadscrew disable`.
///
/// # Errors
/// The axis is lost, or is not off in time.
pub fn disable(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    tell(&axis.disable()?, args)
}

/// `leadscrew home`.
///
/// # Errors
/// The axis is lost, refuses, or finds no origin.
pub fn home(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    let status = axis
        .home()
        .map_err(|error| named_request(error, "Homing"))?;
    tell(&status, args)
}

/// Checks what is asked of `leadscrew move` before the axis is.
///
/// # Errors
/// A feed that is none.
pub fn check_move(args: &MoveArgs) -> Result<(), CommandError> {
    if args.feed > 0.0 {
        Ok(())
    } else {
        Err(CommandError::Usage(format!(
            "--feed {}: a feed is above 0 mm/min; the direction is that of the target",
            args.feed
        )))
    }
}

/// `leadscrew move`.
///
/// # Errors
/// The axis is lost, refuses, faults, or does not arrive.
pub fn go(axis: &mut Axis, args: &MoveArgs) -> Result<(), CommandError> {
    let target_mm = match (args.target, args.by) {
        (_, Some(by)) => axis.status()?.setpoint_mm + by,
        (target, None) => target.unwrap_or_default(),
    };
    tell(&axis.move_and_wait(target_mm, args.feed)?, &args.output)
}

/// How long a jog lasts.
///
/// # Errors
/// No time that can be.
pub fn time(args: &JogArgs) -> Result<Option<Duration>, CommandError> {
    match args.seconds {
        None => Ok(None),
        Some(seconds) if (0.0..=LONGEST_S).contains(&seconds) => {
            Ok(Some(Duration::from_secs_f64(seconds)))
        }
        Some(seconds) => Err(CommandError::Usage(format!(
            "--for {seconds}: a jog lasts 0 to {LONGEST_S} s"
        ))),
    }
}

/// `leadscrew jog`.
///
/// # Errors
/// The axis is lost, refuses, or faults.
pub fn jog(axis: &mut Axis, args: &JogArgs) -> Result<(), CommandError> {
    let time = time(args)?;
    let (end, status) = jogging::jog(axis, args.feed, time, || {
        // Nobody may be listening.
        let _ = writeln!(std::io::stderr(), "jogging: Ctrl-C stops the axis");
    })?;
    if !args.output.json {
        print(&format!("{}\n", end.text()))?;
    }
    tell(&status, &args.output)
}

/// `leadscrew hold`.
///
/// # Errors
/// The axis is lost, or refuses.
pub fn hold(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    axis.hold()?;
    tell_soon(axis, args)
}

/// `leadscrew resume`.
///
/// # Errors
/// The axis is lost, or refuses.
pub fn resume(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    axis.resume()?;
    tell(&axis.wait_for_rest()?, args)
}

/// `leadscrew stop`.
///
/// # Errors
/// The axis is lost, or does not stand in time.
pub fn stop(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    tell(&axis.stop()?, args)
}

/// The override that is asked for, %.
///
/// # Errors
/// One that cannot be.
pub fn percent(args: &OverrideArgs) -> Result<u16, CommandError> {
    let percent = u16::try_from(args.percent).ok();
    percent
        .filter(|percent| *percent <= 200)
        .ok_or_else(|| CommandError::Usage(format!("override {}: choose 0 to 200 %", args.percent)))
}

/// `leadscrew override`.
///
/// # Errors
/// The axis is lost, or refuses.
pub fn set_override(axis: &mut Axis, args: &OverrideArgs) -> Result<(), CommandError> {
    let percent = percent(args)?;
    axis.set_override(percent)
        .map_err(|error| named_request(error, "The override"))?;
    tell_soon(axis, &args.output)
}

/// `leadscrew restart`.
///
/// # Errors
/// The axis is lost, or refuses.
pub fn restart(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    axis.restart()
        .map_err(|error| named_request(error, "The restart"))?;
    tell(&axis.status()?, args)
}
