//! `leadscrew calibrate-probe`: trigger delay, stylus and run-out of a touch probe from tables of touches.

use std::fmt::Write as _;
use std::path::Path;

use leadscrew_process::metrology::fitted::{Quality, Settings};
use leadscrew_process::probing::Value;
use leadscrew_process::probing::delay::{self, SpeedTouch, TriggerDelay};
use leadscrew_process::probing::run_out::{self, RunOut, TurnedTouch};
use leadscrew_process::probing::stylus::{self, Artefact, Reference, Stylus};
use serde::Serialize;

use super::{print, print_json};
use crate::cli::{CalibrateProbeCommand, FitArgs};
use crate::error::CommandError;
use crate::text_file;

/// Degrees from one row of the table of the radius to the next.
const STEP_DEG: u32 = 30;

/// Runs the command.
///
/// # Errors
/// Tables that are none, touches that do not tell what they have to.
pub fn run(command: &CalibrateProbeCommand) -> Result<(), CommandError> {
    match command {
        CalibrateProbeCommand::Delay { files, how } => {
            let mut touches = Vec::new();
            for file in files {
                touches.extend(read(file, SpeedTouch::read)?);
            }
            let found = delay::find(&touches, &settings(how)).map_err(data)?;
            tell("delay", &found, how, delay_text)
        }
        CalibrateProbeCommand::Stylus {
            file,
            ring,
            boss,
            sphere,
            orders,
            ball_radius,
            how,
        } => {
            let artefacts = [Artefact::Ring, Artefact::Boss, Artefact::Sphere];
            let named = [ring, boss, sphere].into_iter().zip(artefacts);
            let mut known =
                named.filter_map(|(diameter, artefact)| diameter.map(|mm| (artefact, mm)));
            let (artefact, diameter_mm) = known
                .next_back()
                .ok_or_else(|| CommandError::Usage("give --ring, --boss or --sphere".to_owned()))?;
            if let Some(ball) = ball_radius {
                leadscrew::units::checked("--ball-radius", *ball, 0.0, 1000.0)
                    .map_err(|error| CommandError::Usage(format!("{error} mm")))?;
            }
            let triggers = read(file, |text| stylus::read(text, artefact))?;
            let reference = Reference {
                artefact,
                diameter_mm,
                orders: *orders,
            };
            let found =
                stylus::calibrate(&reference, &triggers, &settings(how)).map_err(of(file))?;
            tell("stylus", &found, how, |found| {
                stylus_text(found, *ball_radius)
            })
        }
        CalibrateProbeCommand::RunOut { file, how } => {
            let touches = read(file, TurnedTouch::read)?;
            let found = run_out::find(&touches, &settings(how)).map_err(of(file))?;
            tell("run-out", &found, how, run_out_text)
        }
    }
}

fn settings(how: &FitArgs) -> Settings {
    Settings {
        without_outliers: how.without_outliers,
        ..Settings::default()
    }
}

fn data(error: impl std::fmt::Display) -> CommandError {
    CommandError::Data(error.to_string())
}

/// An error of a file as a whole.
fn of<E: std::fmt::Display>(path: &Path) -> impl Fn(E) -> CommandError {
    move |error| data(format!("{}: {error}", path.display()))
}

fn read<T>(
    path: &Path,
    parse: impl Fn(&str) -> Result<Vec<T>, leadscrew_nc::source::Complaint>,
) -> Result<Vec<T>, CommandError> {
    parse(&text_file::read(path)?).map_err(CommandError::content(path))
}

/// What was found, with what it is.
#[derive(Serialize)]
struct Told<'r, T> {
    schema: String,
    #[serde(flatten)]
    found: &'r T,
}

fn tell<T: Serialize>(
    what: &str,
    found: &T,
    how: &FitArgs,
    text: impl Fn(&T) -> String,
) -> Result<(), CommandError> {
    if how.output.json {
        let schema = format!("leadscrew/calibrate-probe-{what}/1");
        print_json(&Told { schema, found })
    } else {
        print(&text(found))
    }
}

/// A value with its 1σ, times `factor`.
fn with_sigma(value: Value, factor: f64, digits: usize) -> String {
    let number = value.value * factor;
    value.sigma.map_or_else(
        || format!("{number:.digits$}"),
        |sigma| format!("{number:.digits$} ± {:.digits$}", sigma * factor),
    )
}

fn quality_text(quality: &Quality) -> String {
    let mut text = format!(
        "\nresiduals {:.5} mm from end to end over {} touches, {} of them redundant\n",
        quality.peak_to_valley_mm(),
        quality.residuals.len(),
        quality.freedom
    );
    let outliers = quality.outliers();
    if !outliers.is_empty() {
        let numbers: Vec<_> = outliers
            .iter()
            .map(|index| (index + 1).to_string())
            .collect();
        let what = if quality.left_out {
            "left out"
        } else {
            "still in it: --without-outliers leaves them out"
        };
        let _ = writeln!(
            text,
            "touches that do not fit: {} ({what})",
            numbers.join(", ")
        );
    }
    text
}

fn delay_text(found: &TriggerDelay) -> String {
    let mut text = format!(
        "trigger delay  {} µs, to be added to probe.trigger_delay_s\n\
         contact        {} mm\n\n\
         feed, mm/min  touches      mean, mm      2σ, mm\n",
        with_sigma(found.delay_s, 1e6, 1),
        with_sigma(found.contact_mm, 1.0, 5)
    );
    for speed in &found.speeds {
        let scatter = speed
            .two_sigma_mm
            .map_or_else(|| "-".to_owned(), |mm| format!("{mm:.5}"));
        let _ = writeln!(
            text,
            "{:>12.1} {:>8} {:>13.5} {scatter:>11}",
            speed.velocity_mm_per_min, speed.touches, speed.mean_mm
        );
    }
    text + &quality_text(&found.quality)
}

fn stylus_text(found: &Stylus, ball_radius: Option<f64>) -> String {
    let mut text = format!(
        "effective radius  {} mm\nlobing            {:.5} mm from end to end\n",
        with_sigma(found.radius_mm, 1.0, 5),
        found.lobing_mm
    );
    for lobe in &found.lobes {
        let _ = writeln!(
            text,
            "order {:<2}          cos {} mm, sin {} mm",
            lobe.order,
            with_sigma(lobe.cosine_mm, 1.0, 5),
            with_sigma(lobe.sine_mm, 1.0, 5)
        );
    }
    if let Some(polar) = found.polar_mm {
        let _ = writeln!(text, "along the stylus  {} mm", with_sigma(polar, 1.0, 5));
    }
    let centre = found
        .centre_mm
        .iter()
        .map(|value| with_sigma(*value, 1.0, 5));
    let _ = writeln!(
        text,
        "centre            {} mm",
        centre.collect::<Vec<_>>().join(", ")
    );
    let _ = write!(text, "\ntowards, °   radius, mm");
    let _ = writeln!(
        text,
        "{}",
        if ball_radius.is_some() {
            "   pre-travel, mm"
        } else {
            ""
        }
    );
    for degree in (0..360).step_by(STEP_DEG as usize) {
        let (y, x) = f64::from(degree).to_radians().sin_cos();
        let radius = found.radius_towards([x, y, 0.0]);
        let _ = write!(text, "{degree:>10} {radius:>12.5}");
        if let Some(ball) = ball_radius {
            let _ = write!(text, " {:>16.5}", ball - radius);
        }
        text.push('\n');
    }
    text + &quality_text(&found.quality)
}

fn run_out_text(found: &RunOut) -> String {
    let mut text = String::new();
    let axes = [("x", found.x_mm), ("y", found.y_mm)];
    for (name, value) in axes {
        let value = value.map_or_else(
            || "not seen: touch along this axis, or at a quarter turn".to_owned(),
            |value| format!("{} mm", with_sigma(value, 1.0, 5)),
        );
        let _ = writeln!(text, "stylus in {name}  {value}");
    }
    if let Some(radius) = found.radius_mm {
        let _ = writeln!(
            text,
            "run-out      {radius:.5} mm beside the axis of the spindle"
        );
    }
    for surface in &found.surfaces {
        let along = match surface.along {
            run_out::Along::X => "x",
            run_out::Along::Y => "y",
        };
        let name = if surface.name.is_empty() {
            "surface"
        } else {
            &surface.name
        };
        let place = with_sigma(surface.position_mm, 1.0, 5);
        let _ = writeln!(text, "{name} along {along}  {place} mm");
    }
    text + &quality_text(&found.quality)
}
