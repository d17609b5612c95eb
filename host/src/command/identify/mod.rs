//! `leadscrew identify`: what a simulated machine's drive does, found by experiments.

mod report;

use std::path::Path;

use leadscrew::encoder_map::EncoderMap;
use leadscrew::identification::IdentifyParams;
use leadscrew::units::checked;

use super::{check_replaceable, file_name, is_picture, machine, print, print_json, tick_rate};
use crate::cli::{BenchArgs, IdentifyArgs};
use crate::commissioning::{learned, map_of};
use crate::error::CommandError;
use crate::figures::{self, panel};
use crate::identify::{Bench, Found, IdentifyError, Sample};
use crate::plot::{Colour, Figure, PlotError, Series};
use crate::progress::Progress;
pub(super) use report::Report;

/// Runs the command.
///
/// # Errors
/// Bad usage, a bad machine file, a machine that cannot be identified, or a file that cannot be written.
pub fn run(args: &IdentifyArgs) -> Result<(), CommandError> {
    if let Some(path) = &args.plot {
        if !is_picture(path) {
            return Err(PlotError::Extension { path: path.clone() }.into());
        }
        check_replaceable(
            "--plot",
            path,
            Some(Path::new(&args.bench.simulated.machine)),
        )?;
    }
    let bench = bench(&args.bench)?;
    let image = learned(&bench.machine, bench.seed);
    let found = identify(&args.bench, &bench, map_of(image.as_deref()))?;
    if let Some(path) = &args.plot {
        let _drawing = Progress::endless("drawing");
        figure(&args.bench.simulated.machine, &found.samples).save(path)?;
    }
    let report = Report::new(&args.bench, &bench, &found);
    if args.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

/// The machine and the bounds that the arguments ask for.
pub(super) fn bench(args: &BenchArgs) -> Result<Bench, CommandError> {
    let (_, machine) = machine(&args.simulated.machine)?;
    let usage = |unit: &'static str| {
        move |error: leadscrew::units::RangeError| CommandError::Usage(format!("{error} {unit}"))
    };
    Ok(Bench {
        machine,
        params: IdentifyParams {
            window_mm: checked("--window-mm", args.window_mm, 0.1, 1000.0).map_err(usage("mm"))?,
            ..IdentifyParams::default()
        },
        tick_hz: tick_rate(args.simulated.rate.tick_hz)?,
        nominal_feed_mm_per_min: checked("--nominal-feed", args.nominal_feed, 0.1, 1e6)
            .map_err(usage("mm/min"))?,
        reversed: args.reverse_drive,
        seed: args.simulated.seed,
    })
}

/// Runs the experiments; a refusal names the machine.
pub(super) fn identify(
    args: &BenchArgs,
    bench: &Bench,
    map: Option<EncoderMap<'_>>,
) -> Result<Found, CommandError> {
    let _identifying = Progress::endless("identifying");
    bench.run(map).map_err(|error| match error {
        IdentifyError::Param(error) => CommandError::Usage(error.to_string()),
        refused => CommandError::Data(format!("{}: {refused}", args.simulated.machine)),
    })
}

/// Measured and modelled velocity, and what is left of position.
pub(super) fn figure(machine: &str, samples: &[Sample]) -> Figure {
    let curve = |value: fn(&Sample) -> f64| {
        samples
            .iter()
            .map(|sample| (sample.time_s, value(sample)))
            .collect()
    };
    Figure::new(
        format!("{}: identified", file_name(Path::new(machine))),
        vec![
            panel(
                figures::VELOCITY,
                vec![
                    Series::line("measured", curve(|sample| sample.velocity.0), Colour::Grey),
                    Series::dashed("model", curve(|sample| sample.velocity.1), Colour::Blue),
                ],
            ),
            panel(
                "measured less model, d",
                vec![Series::line(
                    "position",
                    curve(|sample| sample.error_d),
                    Colour::Vermillion,
                )],
            ),
        ],
    )
}
