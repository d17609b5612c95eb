//! `leadscrew autotune`: from experiments on a simulated machine to the parameters of a loop.
//!
//! Nothing is written unless a file is named. What is offered was designed and tried on the identified model alone; the
//! machine itself then shows how well it follows, before and after, with its encoder corrected by a learned map.

pub(super) mod margins;
mod report;

use std::path::Path;

use leadscrew::encoder_map::EncoderMap;
use leadscrew::params::{AxisParams, ParamError};
use leadscrew::settings::Settings;
use leadscrew::tuning::DriveModel;
use leadscrew::tuning::autotune::{AutotuneError, Report as Offer, observer_on};
use leadscrew::units::checked;

use super::identify::{bench, identify};
use super::{check_replaceable, print, print_json, write_file};
use crate::axis_file;
use crate::cli::AutotuneArgs;
use crate::commissioning::{counts_on, feed_within, learned, map_of, offer};
use crate::error::CommandError;
use crate::identify::Bench;
use crate::progress::Progress;
use crate::tracking::{Course, Rig, TrackingFigures};
use report::Report;

/// Distance of the move that shows how well an axis follows, mm.
const MOVE_MM: f64 = 300.0;

/// Largest feed where none is asked for, mm/min: that of the 16K20F3; a slower drive gives less.
const MAX_FEED_MM_PER_MIN: f64 = 9000.0;

/// What is offered, and how it does.
struct Tuned {
    max_feed_mm_per_min: f64,
    file: Settings,
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
    let asked = args
        .max_feed
        .map(|feed| checked("--max-feed", feed, 0.1, 1e6));
    let asked = asked
        .transpose()
        .map_err(|error| CommandError::Usage(format!("{error} mm/min")))?;
    let bench = bench(&args.bench)?;
    let image = learned(&bench.machine, bench.seed);
    let map = map_of(image.as_deref());
    let found = identify(&args.bench, &bench, map)?;
    let model = found.identified.model();
    let max_feed = asked.unwrap_or_else(|| feed_within(&model, MAX_FEED_MM_PER_MIN));
    let tuned = tune(args, &bench, max_feed, &model, map)?;
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
    model: &DriveModel,
    map: Option<EncoderMap<'_>>,
) -> Result<Tuned, CommandError> {
    let _tuning = Progress::endless("tuning");
    let machine = &bench.machine;
    let counts_on = counts_on(machine, map.is_some());
    let refused = |error: AutotuneError| match error {
        AutotuneError::Param(error @ ParamError::FeedTooHigh { .. }) => {
            let most = feed_within(model, max_feed);
            CommandError::Usage(format!(
                "--max-feed {max_feed}: {error}; ask for {most} or less"
            ))
        }
        AutotuneError::Param(error) => CommandError::Usage(error.to_string()),
        error => CommandError::Data(format!("{}: {error}", args.bench.simulated.machine)),
    };
    let (axis, offer) = offer(bench, model, max_feed, &counts_on).map_err(refused)?;
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
        max_feed_mm_per_min: max_feed,
        file: Settings {
            axis,
            observer: observer_on(&counts_on, model),
        },
        offer,
        before,
        follows: [follow(&before), follow(&axis)],
    })
}
