//! `leadscrew measure`: the features of a part by touches of a probe, and the program that makes these.

mod picture;
mod text;

use std::path::Path;

use leadscrew_process::metrology::Settings;
use leadscrew_process::metrology::part::report::FeatureReport;
use leadscrew_process::metrology::part::{self, Part, evaluate, log, program, touches};
use serde::Serialize;

use super::{check_outputs_of, print, print_json, write_file};
use crate::cli::MeasureArgs;
use crate::error::CommandError;
use crate::text_file;

/// The features with what they are.
#[derive(Serialize)]
struct Report<'r> {
    schema: &'static str,
    without_outliers: bool,
    level: f64,
    features: &'r [FeatureReport],
}

/// Runs the command.
///
/// # Errors
/// Bad usage, files that cannot be read or do not go together, features that are not determined.
pub fn run(args: &MeasureArgs) -> Result<(), CommandError> {
    check(args)?;
    let text = text_file::read(&args.part)?;
    let part = part::read(&text).map_err(CommandError::content(&args.part))?;
    if let Some(path) = &args.program {
        return write_program(args, &text, &part, path);
    }
    let touches = match (&args.touches, &args.log) {
        (Some(file), _) => {
            touches::read(&text_file::read(file)?, &part).map_err(CommandError::content(file))?
        }
        (_, Some(file)) => {
            log::read(&text_file::read(file)?, &part).map_err(CommandError::content(file))?
        }
        (None, None) => {
            let text = "expected --touches FILE.csv, --log FILE.txt or --program FILE.ngc";
            return Err(CommandError::Usage(text.to_owned()));
        }
    };
    let settings = Settings {
        level: args.level,
        without_outliers: args.without_outliers,
        ..Settings::default()
    };
    let report = evaluate::evaluate(&text, &part, &touches, &settings)
        .map_err(CommandError::content(&args.part))?;
    if let Some(path) = &args.plot {
        picture::figure(&report).save(path)?;
    }
    if args.json {
        return print_json(&Report {
            schema: "leadscrew/measure/1",
            without_outliers: args.without_outliers,
            level: args.level,
            features: &report.features,
        });
    }
    print(&text::report(&report))
}

fn check(args: &MeasureArgs) -> Result<(), CommandError> {
    if !(args.level > 0.0 && args.level < 1.0) {
        let level = args.level;
        let text = format!("--level {level}: expected more than 0 and less than 1");
        return Err(CommandError::Usage(text));
    }
    for input in [Some(&args.part), args.touches.as_ref(), args.log.as_ref()] {
        check_outputs_of(
            ("--program", args.program.as_deref()),
            ("--plot", args.plot.as_deref()),
            input.map(std::path::PathBuf::as_path),
        )?;
    }
    Ok(())
}

fn write_program(
    args: &MeasureArgs,
    text: &str,
    part: &Part,
    path: &Path,
) -> Result<(), CommandError> {
    let program = program::write(text, part).map_err(CommandError::content(&args.part))?;
    write_file(path, |file| file.write_all(program.as_bytes()))?;
    let touches: usize = part
        .features
        .iter()
        .map(|feature| feature.planned.len())
        .sum();
    print(&format!(
        "{}: {touches} touches; the control logs them to {}: give that to --log\n",
        path.display(),
        part.program.log
    ))
}
