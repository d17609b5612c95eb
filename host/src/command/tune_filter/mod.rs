//! `leadscrew tune-filter`: how much lag for how much noise (P2: Φ = c_t·t_z + c_σ·σ).

mod args;
mod captured;
mod judge;
mod report;
mod scenes;
mod sweep;
mod trend;

use leadscrew::units::checked;

pub use self::args::TuneFilterArgs;
pub use self::scenes::SceneName;

use super::{check_outputs, print, print_json, tick_rate};
use crate::cli::OutputArgs;
use crate::error::CommandError;
use crate::progress::Progress;
use judge::Judge;
use report::{Report, Weights};

/// Largest weight.
const MAX_WEIGHT: f64 = 1e6;

/// Runs the command.
///
/// # Errors
/// Bad usage, a capture or map that cannot be used, or a plot that cannot be written.
pub fn run(args: &TuneFilterArgs) -> Result<(), CommandError> {
    let tick_hz = tick_rate(args.rate.tick_hz)?;
    let weights = weights(args)?;
    let outputs = OutputArgs {
        json: args.json,
        csv: None,
        plot: args.plot.clone(),
    };
    check_outputs(&outputs, args.file.as_deref())?;
    check_outputs(&outputs, args.map.as_deref())?;
    let candidates = sweep::candidates().map_err(|error| CommandError::Data(error.to_string()))?;
    let (source, reference, judges, map) = match (args.scene, &args.file) {
        (Some(scene), _) => {
            let judges = scene.judge(&candidates, tick_hz, args.seed);
            let judges = judges.map_err(|error| CommandError::Usage(error.to_string()))?;
            (scene.description().to_owned(), "truth", judges, None)
        }
        (None, Some(file)) => {
            let (judges, map) = captured::judge(file, args, &candidates, tick_hz)?;
            (file.display().to_string(), "trend", judges, map)
        }
        (None, None) => {
            return Err(CommandError::Usage(
                "tune-filter has nothing to tune on: name a capture, or a scene by --scene"
                    .to_owned(),
            ));
        }
    };
    let entries = report::entries(&candidates, &judges, tick_hz, weights);
    let mut report = Report::new(source, tick_hz, weights, entries);
    report.reference = reference;
    report.ticks = judges.first().map_or(0, Judge::ticks);
    report.map = map;
    if let Some(path) = &args.plot {
        let _drawing = Progress::endless("drawing");
        report.figure().save(path)?;
    }
    if args.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

fn weights(args: &TuneFilterArgs) -> Result<Weights, CommandError> {
    let weight = |name, value| {
        checked(name, value, 0.0, MAX_WEIGHT)
            .map_err(|error| CommandError::Usage(error.to_string()))
    };
    let weights = Weights {
        lag: weight("--lag-weight", args.lag_weight)?,
        sigma: weight("--sigma-weight", args.sigma_weight)?,
    };
    if weights.lag + weights.sigma > 0.0 {
        Ok(weights)
    } else {
        Err(CommandError::Usage(
            "--lag-weight 0 --sigma-weight 0: then all filters are alike; give one of them"
                .to_owned(),
        ))
    }
}
