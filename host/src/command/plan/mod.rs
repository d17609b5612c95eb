//! `leadscrew plan`: encoder, feeds and control cycle of a machine.

mod figure;
mod text;

use leadscrew_process::plan::{Catalogue, Encoder, Machine, MachinePlan, Question};
use serde::Serialize;

use super::{check_outputs_of, print, print_json};
use crate::cli::PlanArgs;
use crate::error::CommandError;
use crate::text_file;

/// The figures of machines.
#[derive(Serialize)]
struct Report<'r> {
    schema: &'static str,
    machines: &'r [MachinePlan],
}

/// What there is.
#[derive(Serialize)]
struct List<'r> {
    schema: &'static str,
    encoders: &'r [Encoder],
    machines: &'r [Machine],
}

/// Runs the command.
///
/// # Errors
/// Bad usage, a catalogue that cannot be used, a plot that cannot be written.
pub fn run(args: &PlanArgs) -> Result<(), CommandError> {
    check_outputs_of(("", None), ("--plot", args.plot.as_deref()), None)?;
    let catalogue = catalogue(args)?;
    if args.list {
        return list(args, &catalogue);
    }
    let question = Question {
        tick_hz: args.rate.tick_hz,
        allowed_d: args.chord,
        max_line_hz: 1000.0 * args.line_khz,
        radii_mm: args.radius.clone(),
    };
    let plans = match machine(args, &catalogue)? {
        Some(machine) => vec![plan(&question, &machine)?],
        None => catalogue
            .machines()
            .iter()
            .map(|machine| plan(&question, machine))
            .collect::<Result<_, _>>()?,
    };
    if let Some(file) = &args.plot {
        let one = args.subject.as_ref().and_then(|_| plans.first());
        figure::of(args.figure, one, &plans, args.chord)
            .map_err(|error| CommandError::Usage(error.to_string()))?
            .save(file)?;
    }
    if args.json {
        return print_json(&Report {
            schema: "leadscrew/plan/1",
            machines: &plans,
        });
    }
    match (&args.subject, &plans[..]) {
        (Some(_), [plan]) => print(&text::machine(plan)),
        _ => print(&text::summary(&plans)),
    }
}

fn plan(question: &Question, machine: &Machine) -> Result<MachinePlan, CommandError> {
    let name = &machine.name;
    let plan = question.machine(machine);
    plan.map_err(|error| CommandError::Usage(format!("{name}: {error}")))
}

/// The built-in catalogue with those of `--catalogue`.
fn catalogue(args: &PlanArgs) -> Result<Catalogue, CommandError> {
    let mut catalogue =
        Catalogue::built_in().map_err(|complaint| CommandError::Data(complaint.to_string()))?;
    for file in &args.catalogue {
        catalogue
            .add(&text_file::read(file)?)
            .map_err(CommandError::content(file))?;
    }
    Ok(catalogue)
}

/// The machine that is named, with the encoder that is to be tried.
fn machine(args: &PlanArgs, catalogue: &Catalogue) -> Result<Option<Machine>, CommandError> {
    let Some(name) = &args.subject else {
        return Ok(None);
    };
    let unknown = |what: &str, name: &str, known: Vec<&str>| {
        let known = known.join(", ");
        CommandError::Usage(format!(
            "{what} {name} is in no catalogue; there are {known}; add yours by --catalogue FILE.toml"
        ))
    };
    let machine = catalogue.machine(name).ok_or_else(|| {
        let known = catalogue.machines().iter().map(|known| &*known.name);
        unknown("the machine", name, known.collect())
    })?;
    let Some(name) = &args.encoder else {
        return Ok(Some(machine.clone()));
    };
    let encoder = catalogue.encoder(name).ok_or_else(|| {
        let known = catalogue.encoders().iter().map(|known| &*known.name);
        unknown("the encoder", name, known.collect())
    })?;
    let fitted = machine.with_encoder(encoder, args.lines);
    fitted
        .map(Some)
        .map_err(|message| CommandError::Usage(format!("--encoder {name}: {message}")))
}

fn list(args: &PlanArgs, catalogue: &Catalogue) -> Result<(), CommandError> {
    if args.json {
        return print_json(&List {
            schema: "leadscrew/plan-catalogue/1",
            encoders: catalogue.encoders(),
            machines: catalogue.machines(),
        });
    }
    print(&text::list(catalogue))
}
