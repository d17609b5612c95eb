//! `leadscrew bode`: frequency responses of the drive and of the closed loop.

use std::fmt::Write as _;

use leadscrew_client::Axis;
use serde::Serialize;

use super::person::Person;
use crate::axis::bode::{Chirp, DriveCurve, Point, Travel, closed_loop, drive};
use crate::cli::BodeArgs;
use crate::command::{check_outputs_of, print, print_json};
use crate::error::CommandError;
use crate::plot::{Colour, Figure, Panel, Series};
use crate::report::text_table;

/// Coherence below which a point is not to be believed.
const LEAST_COHERENCE: f64 = 0.8;

/// What was measured.
#[derive(Debug, Serialize)]
struct Report {
    schema: &'static str,
    full_command_feed_mm_per_min: f64,
    amplitude_percent: f64,
    loop_amplitude_percent: f64,
    centre_percent: f64,
    drive: Option<Vec<Row>>,
    closed_loop: Option<Vec<Row>>,
}

/// A frequency.
#[derive(Debug, Serialize)]
struct Row {
    hz: f64,
    gain_db: f64,
    phase_deg: f64,
    coherence: f64,
    /// What the settings of the observer say; null of the closed loop.
    model_gain_db: Option<f64>,
    model_phase_deg: Option<f64>,
}

/// Runs the command.
///
/// # Errors
/// What cannot be measured, nobody agreed, the axis.
pub fn run(axis: &mut Axis, args: &BodeArgs) -> Result<(), CommandError> {
    check_outputs_of(("", None), ("--plot", args.plot.as_deref()), None)?;
    let chirp = Chirp {
        hz: (args.from_hz, args.to_hz),
        seconds: args.seconds,
        amplitude: args.amplitude / 100.0,
        centre: args.centre / 100.0,
        points: args.points.into(),
    };
    let loop_chirp = Chirp {
        amplitude: args.loop_amplitude / 100.0,
        centre: 0.0,
        ..chirp
    };
    let tick_hz = axis.scale()?.tick_hz;
    chirp.check_drive(tick_hz)?;
    loop_chirp.check(tick_hz)?;
    let full_feed = axis.parameter("motion.full_command_feed_mm_per_min")?;
    let full_feed = full_feed.number().unwrap_or_default();
    let wants = |what: &str| args.only.as_deref().is_none_or(|only| only == what);
    let travel = Travel {
        loop_mm: loop_chirp.travel(full_feed).loop_mm,
        ..chirp.travel(full_feed)
    };
    agree(travel, args, [wants("drive"), wants("loop")])?;
    let was_enabled = axis.status()?.is_enabled;
    if !was_enabled {
        axis.enable()?;
    }
    let mut report = Report {
        schema: "leadscrew/bode/1",
        full_command_feed_mm_per_min: full_feed,
        amplitude_percent: args.amplitude,
        loop_amplitude_percent: args.loop_amplitude,
        centre_percent: args.centre,
        drive: None,
        closed_loop: None,
    };
    if wants("drive") {
        let begin = axis.status()?.position_mm;
        let points = drive(axis, &chirp, full_feed)?;
        let model = DriveCurve::of(axis, full_feed)?;
        report.drive = Some(rows(&points, Some(&model)));
        // Back to where it was, no faster than it came.
        axis.move_and_wait(begin, (args.centre.abs() / 100.0 * full_feed).max(1.0))?;
    }
    if wants("loop") {
        let points = closed_loop(axis, &loop_chirp, full_feed)?;
        report.closed_loop = Some(rows(&points, None));
    }
    if !was_enabled {
        axis.disable()?;
    }
    if let Some(path) = &args.plot {
        report.figure().save(path)?;
    }
    if args.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

/// Says what will move and how far, refuses what is farther than it may be, and asks.
fn agree(travel: Travel, args: &BodeArgs, [drive, closed]: [bool; 2]) -> Result<(), CommandError> {
    let farthest = if drive { travel.drive_mm.abs() } else { 0.0 };
    let swing = if closed { travel.loop_mm } else { 0.0 };
    if farthest.max(swing) > args.travel_mm {
        return Err(CommandError::Usage(format!(
            "the axis would move by {:.1} mm, more than the {} mm of --travel-mm: choose a smaller --centre or fewer --seconds, \
             or allow it",
            farthest.max(swing),
            args.travel_mm
        )));
    }
    let mut text = String::new();
    if drive {
        let _ = writeln!(
            text,
            "The axis will feed by {:.1} mm from where it stands, its loop open, and come back.",
            travel.drive_mm
        );
    }
    if closed {
        let _ = writeln!(
            text,
            "The axis will swing by {:.1} mm to either side of where it stands.",
            travel.loop_mm
        );
    }
    let mut person = Person::new(&args.yes, args.json);
    person.agreed(&format!("{text}Is the way free?"))?;
    Ok(())
}

fn rows(points: &[Point], model: Option<&DriveCurve>) -> Vec<Row> {
    let row = |point: &Point| {
        let model = model.map(|model| model.at(point.hz));
        Row {
            hz: point.hz,
            gain_db: point.gain_db(),
            phase_deg: point.phase_deg,
            coherence: point.coherence,
            model_gain_db: model.map(|model| model.gain_db()),
            model_phase_deg: model.map(|model| model.phase_deg),
        }
    };
    points.iter().map(row).collect()
}

impl Report {
    fn to_text(&self) -> String {
        let mut text = String::new();
        if let Some(rows) = &self.drive {
            let _ = writeln!(
                text,
                "drive: command to velocity, 0 dB is {:.1} mm/min at full command; model: the drive of [observer]\n{}",
                self.full_command_feed_mm_per_min,
                table(rows)
            );
        }
        if let Some(rows) = &self.closed_loop {
            let _ = writeln!(
                text,
                "closed loop: of what is added to the command, the share that the loop takes back\n{}",
                table(rows)
            );
        }
        text
    }

    fn figure(&self) -> Figure {
        let mut gains = Vec::new();
        let mut phases = Vec::new();
        let mut curve = |name: &str, rows: &[Row], colour, of: [fn(&Row) -> Option<f64>; 2]| {
            let points = |of: fn(&Row) -> Option<f64>| -> Vec<(f64, f64)> {
                let at = |row: &Row| of(row).map(|value| (row.hz.log10(), value));
                rows.iter().filter_map(at).collect()
            };
            let [gain, phase] = of.map(points);
            if gain.is_empty() {
                return;
            }
            let series = |points| match name.ends_with("model") {
                true => Series::dashed(name, points, colour),
                false => Series::line(name, points, colour),
            };
            gains.push(series(gain));
            phases.push(series(phase));
        };
        if let Some(rows) = &self.drive {
            let measured: [fn(&Row) -> Option<f64>; 2] =
                [|row| Some(row.gain_db), |row| Some(row.phase_deg)];
            curve("drive", rows, Colour::Blue, measured);
            let model: [fn(&Row) -> Option<f64>; 2] =
                [|row| row.model_gain_db, |row| row.model_phase_deg];
            curve("drive, model", rows, Colour::Black, model);
        }
        if let Some(rows) = &self.closed_loop {
            let measured: [fn(&Row) -> Option<f64>; 2] =
                [|row| Some(row.gain_db), |row| Some(row.phase_deg)];
            curve("closed loop", rows, Colour::Vermillion, measured);
        }
        let x = "log₁₀ of frequency in Hz";
        Figure::new(
            "Frequency responses",
            vec![
                Panel::new(x, "gain, dB", gains),
                Panel::new(x, "phase, degrees", phases),
            ],
        )
    }
}

fn table(rows: &[Row]) -> String {
    let mut table = text_table(&["Hz", "gain, dB", "phase, °", "model, dB", "model, °", ""]);
    for row in rows {
        let figure = |value: Option<f64>, decimals: usize| {
            value.map_or_else(|| "-".to_owned(), |value| format!("{value:.decimals$}"))
        };
        let doubt = if row.coherence < LEAST_COHERENCE {
            format!("coherence {:.2} only", row.coherence)
        } else {
            String::new()
        };
        table.add_row([
            format!("{:.2}", row.hz),
            format!("{:.2}", row.gain_db),
            format!("{:.1}", row.phase_deg),
            figure(row.model_gain_db, 2),
            figure(row.model_phase_deg, 1),
            doubt,
        ]);
    }
    table.trim_fmt()
}
