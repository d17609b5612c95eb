//! `leadscrew setup`: the first commissioning of an axis.

use leadscrew_client::Axis;
use serde::Serialize;

use super::person::Person;
use crate::axis::Guide as _;
use crate::axis::setup::{Answers, Outcome, Steps, setup};
use crate::cli::SetupArgs;
use crate::command::print_json;
use crate::error::CommandError;

/// What was done.
#[derive(Serialize)]
struct Report {
    schema: &'static str,
    #[serde(flatten)]
    outcome: Outcome,
}

/// Runs the command.
///
/// # Errors
/// Bad answers, and whatever a step ends with; what the steps before found is saved.
pub fn run(axis: &mut Axis, args: &SetupArgs) -> Result<(), CommandError> {
    let mut answers = match &args.answers {
        Some(path) => Answers::of_file(path)?,
        None => Answers::default(),
    };
    for given in &args.set {
        let (name, value) = given
            .split_once('=')
            .ok_or_else(|| CommandError::Usage(format!("--set {given}: expected NAME=NUMBER")))?;
        let value = value
            .trim()
            .parse()
            .map_err(|_| CommandError::Usage(format!("--set {given}: {value} is no number")))?;
        answers
            .give(name.trim(), value)
            .map_err(|error| CommandError::Usage(format!("--set {given}: {error}")))?;
    }
    let steps = Steps {
        skip: args.skip.clone(),
        from: args.from,
    };
    let mut person = Person::new(&args.yes, args.json);
    person.tell(
        "Setup of an axis. Have the emergency stop in reach and the axis in the middle of its travel; nothing moves before you agree.",
    );
    let outcome = setup(axis, &mut person, answers, &steps)?;
    if args.json {
        return print_json(&Report {
            schema: "leadscrew/setup/1",
            outcome,
        });
    }
    person.tell("done: the axis is set up, and all of it is saved. Soft limits count once it is homed: leadscrew home");
    Ok(())
}
