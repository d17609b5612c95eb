//! `leadscrew null-offset`: the offset of a drive, measured and set against.

use leadscrew_client::Axis;
use serde::Serialize;

use super::person::Person;
use crate::axis::{Guide as _, NulledOffset, null_offset, read_settings};
use crate::cli::NullOffsetArgs;
use crate::command::print_json;
use crate::error::CommandError;

/// What was measured; levels are shares of full command, drifts mm/min.
#[derive(Serialize)]
struct Report {
    schema: &'static str,
    command_forward: f64,
    command_backward: f64,
    bias_before: f64,
    bias: f64,
    left_before: f64,
    left_after: f64,
    drift_at_zero_before: f64,
    drift_at_bias_before: f64,
    drift_at_zero_after: f64,
    drift_at_bias_after: f64,
    saved: bool,
}

/// Runs the command.
///
/// # Errors
/// An axis without a loop or without room.
pub fn run(axis: &mut Axis, args: &NullOffsetArgs) -> Result<(), CommandError> {
    let mut person = Person::new(&args.yes, args.json);
    let settings = read_settings(axis)?;
    let room = person.room(axis, &settings, &args.room)?;
    person.agreed(
        "The axis goes some mm, a revolution of its encoder, slowly to and fro, loop closed, and stands with its loop open for two \
         seconds, within 1 mm; then the same once more with the offset nulled. Go on?",
    )?;
    let nulled = null_offset(axis, &settings, &room, &mut |text| person.progress(text))?;
    person.tell(&text(&nulled));
    let saved = person.agree(
        "Save all parameters in the axis? (Else they are in force until it is switched off.)",
        true,
    )?;
    if saved {
        axis.save_parameters()?;
        person.tell("saved");
    }
    if args.json {
        return print_json(&Report {
            schema: "leadscrew/null-offset/1",
            command_forward: nulled.forward,
            command_backward: nulled.backward,
            bias_before: nulled.bias_before,
            bias: nulled.bias,
            left_before: nulled.left_before,
            left_after: nulled.left_after,
            drift_at_zero_before: nulled.drift_before.at_zero,
            drift_at_bias_before: nulled.drift_before.at_bias,
            drift_at_zero_after: nulled.drift_after.at_zero,
            drift_at_bias_after: nulled.drift_after.at_bias,
            saved,
        });
    }
    Ok(())
}

fn text(nulled: &NulledOffset) -> String {
    let percent = |level: f64| 100.0 * level;
    let volts = |level: f64| 1e4 * level;
    // A zero has no sign.
    let plain = |figure: f64| if figure.abs() < 5e-5 { 0.0 } else { figure };
    format!(
        "a slow feed takes {:.3} % of full command forward and {:.3} % backward: {:.4} % ({:.1} mV) stand the drive still\n\
         controller.bias was {:.4} %, the loop had to add {:.4} %; now it adds {:.4} %\n\
         open loop, the axis drifts {:.2} mm/min at 0 V and {:.2} mm/min at the bias before, {:.2} mm/min at the bias now (0 where \
         friction holds it)\n\
         to trim the drive's own zero instead: turn its offset until the axis stands at 0 V with the loop open, {:.1} mV at its \
         input, then run null-offset again; the bias comes to nearly 0",
        percent(nulled.forward),
        percent(nulled.backward),
        percent(nulled.bias),
        volts(nulled.bias),
        percent(nulled.bias_before),
        plain(percent(nulled.left_before)),
        plain(percent(nulled.left_after)),
        nulled.drift_before.at_zero,
        nulled.drift_before.at_bias,
        nulled.drift_after.at_bias,
        volts(nulled.bias),
    )
}
