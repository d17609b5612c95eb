//! `leadscrew run`: scripts of moves and checks.

use leadscrew_client::Axis;
use serde::Serialize;

use crate::axis::script::{self, Done, Run, Script};
use crate::cli::RunArgs;
use crate::command::{print, print_json};
use crate::error::CommandError;

/// What came of a script.
#[derive(Debug, Serialize)]
struct Report<'a> {
    schema: &'static str,
    script: String,
    passed: bool,
    steps: &'a [Done],
    failed: Option<Failed>,
}

#[derive(Debug, Serialize)]
struct Failed {
    line: usize,
    step: String,
    why: String,
}

/// Runs the command.
///
/// # Errors
/// The script names what there is not; a step failed; the axis is lost.
pub fn run(axis: &mut Axis, args: &RunArgs, script: &Script) -> Result<(), CommandError> {
    if args.check {
        script::check(axis, script)?;
        let file = script.file.display();
        return print(&format!("{file}: nothing is wrong with it\n"));
    }
    let mut printed = Ok(());
    let run = script::run(axis, script, &mut |done| {
        if !args.output.json && printed.is_ok() {
            printed = print(&line(done));
        }
    })?;
    if run.failure.is_some() && !args.keep {
        // What failed is told; an axis that is lost stops by itself.
        let _ = axis.disable();
    }
    printed?;
    if args.output.json {
        print_json(&report(script, &run))?;
    }
    match run.failure {
        None if args.output.json => Ok(()),
        None => print(&format!("passed: {} steps\n", run.done.len())),
        Some(failure) => Err(failed(script, failure.line, &failure.step, failure.error)),
    }
}

fn line(done: &Done) -> String {
    let Done {
        time_s,
        line,
        step,
        result,
    } = done;
    format!("{time_s:10.3} s  {line:4}  {step:<44}  {result}\n")
}

fn report<'a>(script: &Script, run: &'a Run) -> Report<'a> {
    Report {
        schema: "leadscrew/run/1",
        script: script.file.display().to_string(),
        passed: run.failure.is_none(),
        steps: &run.done,
        failed: run.failure.as_ref().map(|failure| Failed {
            line: failure.line,
            step: failure.step.clone(),
            why: failure.error.to_string(),
        }),
    }
}

/// The error of a step, with its place. One of an axis that is lost keeps its kind.
fn failed(script: &Script, line: usize, step: &str, error: CommandError) -> CommandError {
    if error.exit_code() == 3 {
        return error;
    }
    let file = script.file.display();
    CommandError::Data(format!("{file}:{line}: `{step}`: {error}"))
}
