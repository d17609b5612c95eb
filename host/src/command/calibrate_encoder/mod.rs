//! `leadscrew calibrate-encoder`: where the edges of an encoder really lie, learned from captures.

mod figure;
mod report;

use std::path::{Path, PathBuf};

use leadscrew::calibration::{MAX_EDGES, MIN_EDGES, Requirements};
use leadscrew::encoder_map::Form;

use super::{check_replaceable, is_picture, print, print_json, same_file, tick_rate, write_file};
use crate::calibration::{Calibration, CalibrationError, Motion, Options, learn_from_recordings};
use crate::cli::{CalibrateEncoderArgs, MapForm};
use crate::error::CommandError;
use crate::plot::PlotError;
use crate::progress::Progress;
use crate::recording::Recording;
use report::Report;

/// Largest tolerance that is one, d.
const LARGEST_TOLERANCE_D: f64 = 1.0;

/// Runs the command.
///
/// # Errors
/// Bad usage, captures that cannot be read or do not suffice, or a file that cannot be written.
pub fn run(args: &CalibrateEncoderArgs) -> Result<(), CommandError> {
    if args.files.is_empty() {
        return Err(CommandError::Usage(
            "learn from what? Name captures of steady feeds, or the axis with --port".to_owned(),
        ));
    }
    let options = options(args)?;
    check_outputs(args)?;
    let recordings = read(args)?;
    let calibration = {
        let _learning = Progress::endless("learning");
        learn_from_recordings(&recordings, &options).map_err(|error| told(error, &args.files))?
    };
    if let Some(path) = &args.plot {
        draw(&calibration, path)?;
    }
    write_file(out(args)?, |file| file.write_all(&calibration.image))?;
    let report = Report::new(&calibration, args);
    if args.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

impl From<MapForm> for Form {
    fn from(form: MapForm) -> Self {
        match form {
            MapForm::Full => Self::Full,
            MapForm::Coarse => Self::Coarse,
            MapForm::Phases => Self::Phases,
        }
    }
}

fn edges_per_rev(args: &CalibrateEncoderArgs) -> Result<u32, CommandError> {
    let missing = "captures do not tell the edges of a revolution: state them with --edges-per-rev";
    args.edges_per_rev
        .ok_or_else(|| CommandError::Usage(missing.to_owned()))
}

fn out(args: &CalibrateEncoderArgs) -> Result<&PathBuf, CommandError> {
    let missing = "where is the map to go? Name a file with --out";
    args.out
        .as_ref()
        .ok_or_else(|| CommandError::Usage(missing.to_owned()))
}

fn options(args: &CalibrateEncoderArgs) -> Result<Options, CommandError> {
    let tick_hz = tick_rate(args.rate.tick_hz)?;
    let edges = edges_per_rev(args)?;
    if !(MIN_EDGES..=MAX_EDGES).contains(&edges) || !edges.is_multiple_of(4) {
        return Err(CommandError::Usage(format!(
            "--edges-per-rev {edges}: expected 4 times the lines, a multiple of 4 from {MIN_EDGES} to {MAX_EDGES}"
        )));
    }
    let form = Form::from(args.form);
    if args.channels.z.is_none() && form != Form::Phases {
        return Err(CommandError::Usage(
            CalibrationError::NoIndexChannel.to_string(),
        ));
    }
    let tolerance = args.tolerance;
    if !(tolerance > 0.0 && tolerance <= LARGEST_TOLERANCE_D) {
        return Err(CommandError::Usage(format!(
            "--tolerance {tolerance}: allowed are more than 0 and up to {LARGEST_TOLERANCE_D} d"
        )));
    }
    Ok(Options {
        edges,
        tick_hz,
        motion: if args.coast {
            Motion::Coast
        } else {
            Motion::Steady
        },
        form,
        indexed: args.channels.z.is_some(),
        requirements: Requirements {
            two_speeds: !args.accept_one_speed,
            both_directions: !args.accept_one_direction,
            max_disagreement_d: tolerance,
            max_edge_residual_d: tolerance,
        },
        curve: args.plot.is_some(),
    })
}

fn check_outputs(args: &CalibrateEncoderArgs) -> Result<(), CommandError> {
    let mut outputs = vec![("--out", out(args)?.clone())];
    if let Some(path) = &args.plot {
        if !is_picture(path) {
            return Err(PlotError::Extension { path: path.clone() }.into());
        }
        outputs.extend([("--plot", path.clone()), ("--plot", waves_path(path))]);
    }
    for (number, (option, path)) in outputs.iter().enumerate() {
        check_replaceable(option, path, None)?;
        for input in &args.files {
            check_replaceable(option, path, Some(input))?;
        }
        let clash = |(_, other): &&(&str, PathBuf)| other == path || same_file(other, path);
        if outputs[..number].iter().any(|other| clash(&other)) {
            return Err(CommandError::Usage(format!(
                "{option} {}: is written twice: choose another name",
                path.display()
            )));
        }
    }
    Ok(())
}

fn read(args: &CalibrateEncoderArgs) -> Result<Vec<Recording>, CommandError> {
    let read = |file: &PathBuf| Ok(args.channels.read(file)?);
    args.files.iter().map(read).collect()
}

/// An error with the file that it is of.
fn told(error: CalibrationError, files: &[PathBuf]) -> CommandError {
    let file = match &error {
        CalibrationError::Run { recording, .. }
        | CalibrationError::IndexNeverHigh { recording } => files.get(*recording),
        _ => None,
    };
    CommandError::Data(match file {
        Some(file) => format!("{}: {error}", file.display()),
        None => error.to_string(),
    })
}

/// `map.png` makes `map-waves.png`.
fn waves_path(path: &Path) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push("-waves");
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

fn draw(calibration: &Calibration, path: &Path) -> Result<(), CommandError> {
    let _drawing = Progress::endless("drawing");
    let Some(curve) = &calibration.curve else {
        return Err(CommandError::Data(
            "nothing can be drawn: that takes an index and two runs in one direction; leave out --plot".to_owned(),
        ));
    };
    figure::along_the_revolution(curve).save(path)?;
    figure::by_wavelength(curve).save(&waves_path(path))?;
    Ok(())
}
