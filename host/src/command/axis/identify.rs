//! `leadscrew --port … identify`: what the drive of an axis does.

use leadscrew::identification::IdentifyParams;
use leadscrew::settings::Settings;
use leadscrew::units::checked;
use leadscrew_client::Axis;

use super::person::Person;
use crate::axis::{Guide as _, IdentifiedAxis, identify, read_settings};
use crate::cli::{BenchArgs, IdentifyArgs};
use crate::command::identify::{Report, figure};
use crate::command::{check_replaceable, is_picture, print, print_json};
use crate::error::CommandError;
use crate::plot::PlotError;

/// Runs the command.
///
/// # Errors
/// Bad usage, an axis that cannot be identified, a file that cannot be written.
pub fn run(axis: &mut Axis, port: &str, args: &IdentifyArgs) -> Result<(), CommandError> {
    if let Some(path) = &args.plot {
        if !is_picture(path) {
            return Err(PlotError::Extension { path: path.clone() }.into());
        }
        check_replaceable("--plot", path, None)?;
    }
    let mut person = Person::new(&args.yes, args.json);
    let settings = read_settings(axis)?;
    let (found, report) = identified(axis, port, &settings, &args.bench, &mut person)?;
    if let Some(path) = &args.plot {
        figure(port, &found.samples).save(path)?;
    }
    if args.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

/// Asks, identifies, and reports.
pub fn identified(
    axis: &mut Axis,
    port: &str,
    settings: &Settings,
    args: &BenchArgs,
    person: &mut Person,
) -> Result<(IdentifiedAxis, Report), CommandError> {
    let window_mm = checked("--window-mm", args.window_mm, 0.1, 1000.0)
        .map_err(|error| CommandError::Usage(format!("{error} mm")))?;
    let params = IdentifyParams {
        window_mm,
        max_feed_mm_per_min: settings
            .axis
            .motion
            .full_command_feed_mm_per_min
            .min(IdentifyParams::default().max_feed_mm_per_min),
        ..IdentifyParams::default()
    };
    person.agreed(&format!(
        "Experiments move the axis, loop open, {:.1} mm at most to either side of where it stands, with {} mm/min at most, for half a \
         minute; the first are pulses of some tenths of a mm that prove the sign. Go on?",
        0.5 * window_mm,
        params.max_feed_mm_per_min
    ))?;
    let found = identify(axis, settings, &params, &mut |text| person.progress(text))?;
    let report = Report::of_axis(port, settings.axis.tick_hz, window_mm, &found);
    Ok((found, report))
}
