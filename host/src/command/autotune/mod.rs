//! `leadscrew autotune`: from experiments on a simulated machine to the parameters of a loop.
//!
//! Nothing is written unless a file is named. What is offered was designed and tried on the identified model alone; the
//! machine itself then shows how well it follows, before and after, with its encoder corrected by a learned map.

mod report;

use std::path::Path;

use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::{Config, ObserverParams};
use leadscrew::params::{AxisParams, MotionParams};
use leadscrew::tuning::autotune::{
    AutotuneError, EstimatorChoice, Report as Offer, autotune, observer_on,
};
use leadscrew::units::checked;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::observer_params;

use super::identify::{bench, identify};
use super::{check_replaceable, print, print_json, write_file};
use crate::axis_file::{self, AxisFile};
use crate::calibration::{Procedure, learn_simulated};
use crate::cli::AutotuneArgs;
use crate::error::CommandError;
use crate::identify::Bench;
use crate::progress::Progress;
use crate::tracking::{Course, Rig, TrackingFigures};
use report::Report;

/// Distance of the move that shows how well an axis follows, mm.
const MOVE_MM: f64 = 300.0;

/// What is offered, and how it does.
struct Tuned {
    file: AxisFile,
    offer: Offer,
    before: AxisParams,
    /// Figures on the machine; none where the axis does not come to its goal.
    follows: [Option<TrackingFigures>; 2],
}

/// Runs the command.
///
/// # Errors
/// Bad usage, a bad machine file, a machine that cannot be identified or tuned, or a file that cannot be written.
pub fn run(args: &AutotuneArgs) -> Result<(), CommandError> {
    if let Some(path) = &args.out {
        check_replaceable(
            "--out",
            path,
            Some(Path::new(&args.bench.simulated.machine)),
        )?;
    }
    let max_feed = checked("--max-feed", args.max_feed, 0.1, 1e6)
        .map_err(|error| CommandError::Usage(format!("{error} mm/min")))?;
    let bench = bench(&args.bench)?;
    let found = identify(&args.bench, &bench)?;
    let tuned = tune(args, &bench, max_feed, &found.identified.model())?;
    if let Some(path) = &args.out {
        let text = axis_file::dump(&tuned.file);
        write_file(path, |file| file.write_all(text.as_bytes()))?;
    }
    let report = Report::new(args, &bench, &found, &tuned);
    if args.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

fn tune(
    args: &AutotuneArgs,
    bench: &Bench,
    max_feed: f64,
    model: &leadscrew::tuning::DriveModel,
) -> Result<Tuned, CommandError> {
    let _tuning = Progress::endless("tuning");
    let machine = &bench.machine;
    let image = learned(machine, bench.seed);
    let map = image
        .as_deref()
        .and_then(|image| EncoderMap::from_bytes(image).ok());
    let counts_on = if map.is_some() || machine.encoder.disc.line_sigma_d == 0.0 {
        ObserverParams::default()
    } else {
        observer_params(machine, false)
    };
    let refused = |error: AutotuneError| match error {
        AutotuneError::Param(error) => {
            CommandError::Usage(format!("--max-feed {max_feed}: {error}"))
        }
        error => CommandError::Data(format!("{}: {error}", args.bench.simulated.machine)),
    };
    let start = Config::of_16k20f3().map_err(|error| CommandError::Data(error.to_string()))?;
    let base = bench
        .axis_params()
        .map_err(|error| CommandError::Usage(error.to_string()))?;
    let base = AxisParams {
        motion: MotionParams {
            max_feed_mm_per_min: max_feed,
            ..base.motion
        },
        estimator: EstimatorConfig::Observer(start),
        ..base
    };
    let (axis, offer) =
        autotune(model, &base, &EstimatorChoice::Observer(counts_on)).map_err(refused)?;
    let course = Course::Move {
        distance_mm: MOVE_MM,
        feed_mm_per_min: max_feed,
    };
    let before = AxisParams {
        motion: axis.motion,
        ..bench
            .axis_params()
            .map_err(|error| CommandError::Usage(error.to_string()))?
    };
    let follow = |params: &AxisParams| {
        let mut rig = Rig::new(machine, params, map, bench.seed).ok()?;
        rig.run(&course).ok()
    };
    Ok(Tuned {
        file: AxisFile {
            axis,
            observer: observer_on(&counts_on, model),
        },
        offer,
        before,
        follows: [follow(&before), follow(&axis)],
    })
}

/// A map of the machine's encoder, where it has a disc with errors.
fn learned(machine: &MachineParams, seed: u64) -> Option<Vec<u8>> {
    let has_disc = machine.mount.linear_scale < 0.5 && machine.encoder.disc.line_sigma_d > 0.0;
    let learn = || learn_simulated(&machine.encoder, seed, &Procedure::default()).ok();
    has_disc.then(learn).flatten()
}
