//! `leadscrew probe`: touches, one or many, and what they scatter.

use std::fmt::Write as _;
use std::path::Path;

use leadscrew::probe::ProbeEnd;
use leadscrew::supervisor::Fault;
use leadscrew_client::{Axis, Error, ProbeStatus, Touch};
use serde::Serialize;

use crate::axis::values::named_request;
use crate::cli::ProbeArgs;
use crate::command::{print, print_json, write_file};
use crate::error::CommandError;
use crate::fault_names::probe_end_name;
use crate::report::text_table;

/// Checks what is asked before the axis is.
///
/// # Errors
/// A feed or a way back that is none.
pub fn check(args: &ProbeArgs) -> Result<(), CommandError> {
    let message = if args.feed.is_nan() || args.feed <= 0.0 {
        format!(
            "--feed {}: a feed is above 0 mm/min; the direction is that of --towards",
            args.feed
        )
    } else if args.retract.is_nan() || args.retract < 0.0 {
        format!("--retract {}: a way back is 0 mm or more", args.retract)
    } else if args.repeat > 1 && args.retract == 0.0 {
        "--repeat needs a way back: give --retract".to_owned()
    } else {
        return Ok(());
    };
    Err(CommandError::Usage(message))
}

/// Runs the command.
///
/// # Errors
/// The axis is lost, refuses or faults; probing that did not end with a good touch.
pub fn run(axis: &mut Axis, args: &ProbeArgs) -> Result<(), CommandError> {
    if args.enable {
        axis.enable()
            .map_err(|error| named_request(error, "Enabling the axis"))?;
    }
    let touched = touch(axis, args);
    if args.enable {
        axis.disable()?;
    }
    let (touches, failed) = touched.map_err(commissioned)?;
    if let Some(path) = &args.csv
        && !touches.is_empty()
    {
        write_csv(path, &touches)?;
    }
    let report = Report::new(&touches, failed.as_ref());
    if args.output.json {
        print_json(&report)?;
    } else if !touches.is_empty() {
        print(&report.to_text())?;
    }
    match failed {
        None => Ok(()),
        Some(status) => Err(CommandError::Data(status.end.map_or_else(
            || "probing came to an end that this tool does not know".to_owned(),
            |end| end.to_string(),
        ))),
    }
}

/// A touch creeps, and a loop of the factory stands still in a machine's friction until it is too far behind.
fn commissioned(error: CommandError) -> CommandError {
    let fault = match &error {
        CommandError::Axis(Error::Faulted(number)) => Fault::from_number(*number),
        _ => None,
    };
    if fault != Some(Fault::FollowingError) {
        return error;
    }
    CommandError::Data(format!(
        "{error} A touch creeps, which the factory's loop cannot on a machine with friction: commission the axis by `leadscrew setup` first"
    ))
}

/// Touches until there are enough or one is not good: that one comes apart.
fn touch(
    axis: &mut Axis,
    args: &ProbeArgs,
) -> Result<(Vec<Touch>, Option<ProbeStatus>), CommandError> {
    let mut touches = Vec::new();
    for _ in 0..args.repeat {
        let status = axis.probe(args.towards, args.feed, args.retract)?;
        match (status.end, status.touch) {
            (Some(ProbeEnd::Touched), Some(touch)) => touches.push(touch),
            _ => return Ok((touches, Some(status))),
        }
    }
    Ok((touches, None))
}

fn write_csv(path: &Path, touches: &[Touch]) -> Result<(), CommandError> {
    let mut text = String::from(
        "touch,position_mm,velocity_mm_per_min,sigma_mm,overtravel_mm,raw_d,edges,tick\n",
    );
    for (number, touch) in (1..).zip(touches) {
        let _ = writeln!(
            text,
            "{number},{:.6},{:.3},{:.6},{:.4},{:.4},{},{}",
            touch.position_mm,
            touch.velocity_mm_per_min,
            touch.sigma_mm,
            touch.overtravel_mm,
            touch.raw_d,
            touch.edges,
            touch.tick
        );
    }
    write_file(path, |file| file.write_all(text.as_bytes()))
}

/// A touch in the report.
#[derive(Clone, Copy, Debug, Serialize)]
struct Row {
    position_mm: f64,
    sigma_mm: f64,
    velocity_mm_per_min: f64,
    overtravel_mm: f64,
    raw_d: f64,
    edges: u32,
    tick: u32,
}

impl From<&Touch> for Row {
    fn from(touch: &Touch) -> Self {
        Self {
            position_mm: touch.position_mm,
            sigma_mm: touch.sigma_mm,
            velocity_mm_per_min: touch.velocity_mm_per_min,
            overtravel_mm: touch.overtravel_mm,
            raw_d: touch.raw_d,
            edges: touch.edges,
            tick: touch.tick,
        }
    }
}

/// What the touches came to.
#[derive(Debug, Serialize)]
struct Report {
    schema: &'static str,
    touches: Vec<Row>,
    mean_mm: Option<f64>,
    /// Twice the standard deviation.
    two_sigma_mm: Option<f64>,
    /// The first touch less the mean of the others: a machine that is not warm, play that is taken up.
    first_less_rest_mm: Option<f64>,
    largest_overtravel_mm: Option<f64>,
    glitches: Option<u16>,
    /// How the one ended that was not good.
    failed: Option<&'static str>,
}

impl Report {
    fn new(touches: &[Touch], failed: Option<&ProbeStatus>) -> Self {
        let places: Vec<f64> = touches.iter().map(|touch| touch.position_mm).collect();
        let mean = |places: &[f64]| {
            (!places.is_empty()).then(|| places.iter().sum::<f64>() / places.len() as f64)
        };
        let mean_mm = mean(&places);
        let two_sigma_mm = mean_mm.filter(|_| places.len() > 1).map(|mean| {
            let squares: f64 = places.iter().map(|place| (place - mean).powi(2)).sum();
            2.0 * (squares / (places.len() - 1) as f64).sqrt()
        });
        let rest = places.get(1..).and_then(mean);
        Self {
            schema: "leadscrew/probe/1",
            touches: touches.iter().map(Row::from).collect(),
            mean_mm,
            two_sigma_mm,
            first_less_rest_mm: rest.map(|rest| places[0] - rest),
            largest_overtravel_mm: touches
                .iter()
                .map(|touch| touch.overtravel_mm)
                .reduce(f64::max),
            glitches: failed.map(|status| status.glitches),
            failed: failed.and_then(|status| status.end).map(probe_end_name),
        }
    }

    fn to_text(&self) -> String {
        let mut table = text_table(&[
            "touch",
            "position, mm",
            "1σ, mm",
            "feed, mm/min",
            "overtravel, mm",
            "edges",
        ]);
        for (number, row) in (1..).zip(&self.touches) {
            let Row {
                position_mm,
                sigma_mm,
                velocity_mm_per_min,
                overtravel_mm,
                edges,
                ..
            } = row;
            table.add_row([
                format!("{number}"),
                format!("{position_mm:.5}"),
                format!("{sigma_mm:.5}"),
                format!("{velocity_mm_per_min:.1}"),
                format!("{overtravel_mm:.3}"),
                format!("{edges}"),
            ]);
        }
        let mut text = format!("{table}\n");
        if let (Some(mean), Some(two_sigma), Some(first)) =
            (self.mean_mm, self.two_sigma_mm, self.first_less_rest_mm)
        {
            let _ = write!(
                text,
                "\nmean             {mean:.5} mm\n\
                 2σ               {two_sigma:.5} mm\n\
                 first less rest  {first:+.5} mm\n"
            );
        }
        text
    }
}
