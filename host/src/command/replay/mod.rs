//! `leadscrew replay`: the core on a capture of a real encoder.

mod axis;
mod report;

use std::path::Path;

use leadscrew::capture::CaptureHealth;
use leadscrew::edges::EdgeConfig;
use leadscrew::estimator::{Estimate, EstimatorConfig, Variances};
use leadscrew::uncertainty::EdgeErrors;
use leadscrew::units::Position;

use super::choice::{at_rate, chosen};
use super::map_figures::{MapFigures, TieLog};
use super::span::Span;
use super::{
    MAX_TICKS, check_outputs, file_name, print, print_json, tick_rate, too_long, write_file,
};
use crate::cli::ReplayArgs;
use crate::error::CommandError;
use crate::figures::{self, acceleration_points, estimator_series, panel, velocity_points};
use crate::listening::Listening;
use crate::map_file::MapFile;
use crate::plot::Figure;
use crate::progress::Progress;
use crate::recording::Recording;
use crate::report::CsvReport;
use crate::sampler::{Sampler, Totals};
use crate::simulation::all_estimators;
use report::Report;

/// The estimator of the CSV where none is asked for.
const DEFAULT_ESTIMATOR: &str = "exponential";

/// Runs the command.
///
/// # Errors
/// Bad usage, a capture that cannot be read, or a file that cannot be written.
pub fn run(args: &ReplayArgs) -> Result<(), CommandError> {
    if crate::recorded::is_recording(&args.file) {
        return axis::run(args);
    }
    let tick_hz = tick_rate(args.rate.tick_hz)?;
    let configs = match &args.estimator {
        Some(name) => vec![chosen(name, args.window, args.answer.as_deref())?],
        None => all_estimators(),
    };
    let configs = configs
        .into_iter()
        .map(|config| at_rate(config, tick_hz))
        .collect::<Result<Vec<_>, _>>()?;
    let span = Span::new(args.from_s, args.to_s)?;
    check_outputs(&args.output, Some(&args.file))?;
    check_outputs(&args.output, args.map.as_deref())?;
    let map = args.map.as_deref().map(MapFile::read).transpose()?;
    let recording = args.channels.read(&args.file)?;
    let replay = Replay::of(&args.file, &recording, tick_hz, &configs, map.as_ref())?;

    if let Some(path) = &args.output.csv {
        replay.write_csv(path)?;
    }
    if let Some(path) = &args.output.plot {
        let _drawing = Progress::endless("drawing");
        replay.figure(&args.file).save(path)?;
    }
    let map = map.as_ref().zip(replay.tie);
    let map = map
        .map(|(file, tie)| MapFigures::new(file, tie, args.channels.z.is_some()))
        .transpose()?;
    let report = Report::new(&replay, &span, map);
    if args.output.json {
        print_json(&report)
    } else {
        print(&report.to_text(&args.file))
    }
}

/// Points of a curve from estimates at a control rate.
type Curve = fn(&[Estimate], f64) -> Vec<(f64, f64)>;

/// A recording run through the core.
struct Replay {
    tick_hz: f64,
    totals: Totals,
    health: CaptureHealth,
    counts: Vec<i64>,
    tracks: Vec<Track>,
    /// `None` without a map.
    tie: Option<TieLog>,
}

/// The estimates of one estimator.
struct Track {
    config: EstimatorConfig,
    estimates: Vec<Estimate>,
    variances: Vec<Variances>,
}

impl Replay {
    fn of(
        file: &Path,
        recording: &Recording,
        tick_hz: f64,
        configs: &[EstimatorConfig],
        map: Option<&MapFile>,
    ) -> Result<Self, CommandError> {
        let mut sampler = Sampler::new(recording, tick_hz);
        let ticks = sampler.ticks();
        if ticks > MAX_TICKS {
            return Err(too_long(file, ticks, tick_hz));
        }
        let scale = EdgeConfig::new(tick_hz, sampler.timer_hz() as f64, &EdgeErrors::default())
            .map_err(|error| CommandError::Usage(error.to_string()))?;
        let mut progress = Progress::new("replaying", ticks);
        let mut listening = Listening::new(configs, scale);
        let mut tie = None;
        if let Some(map) = map {
            listening = listening.with_map(map.map()?);
            tie = Some(TieLog::default());
        }
        let track = |&config: &EstimatorConfig| Track {
            config,
            estimates: Vec::new(),
            variances: Vec::new(),
        };
        let mut tracks: Vec<_> = configs.iter().map(track).collect();
        let mut counts = Vec::new();
        // Told from where the recording starts.
        let start = sampler.start_count();
        let start_position = Position::saturating_from_num(start);
        while let Some(capture) = sampler.next_capture() {
            let count = listening.hear(&capture, None, |index, estimate| {
                tracks[index].estimates.push(Estimate {
                    position: estimate.position - start_position,
                    ..estimate
                });
            });
            for (index, track) in tracks.iter_mut().enumerate() {
                track.variances.extend(listening.variances(index));
            }
            if let Some(tie) = &mut tie {
                tie.note(counts.len(), &listening);
            }
            counts.push(count - start);
            progress.step();
        }
        Ok(Self {
            tick_hz,
            totals: sampler.totals(),
            health: listening.health(),
            counts,
            tracks,
            tie,
        })
    }

    fn write_csv(&self, path: &Path) -> Result<(), CommandError> {
        let wanted = self
            .tracks
            .iter()
            .find(|track| track.config.name() == DEFAULT_ESTIMATOR);
        let Some(track) = wanted.or(self.tracks.first()) else {
            return Ok(());
        };
        write_file(path, |file| {
            let mut report = CsvReport::new(file, self.tick_hz, &[])?;
            let mut progress = Progress::new("writing", self.counts.len() as u64);
            let said = track.estimates.iter().zip(&track.variances);
            for (tick, ((estimate, variances), count)) in said.zip(&self.counts).enumerate() {
                progress.step();
                report.row(tick as u64, *count, estimate, variances, &[])?;
            }
            report.finish()
        })
    }

    fn figure(&self, file: &Path) -> Figure {
        let curves = |points: Curve| {
            let series = |track: &Track| {
                estimator_series(track.config.name(), points(&track.estimates, self.tick_hz))
            };
            self.tracks.iter().map(series).collect()
        };
        Figure::new(
            format!("{} at {} Hz", file_name(file), self.tick_hz),
            vec![
                panel(figures::VELOCITY, curves(velocity_points)),
                panel(figures::ACCELERATION, curves(acceleration_points)),
            ],
        )
    }
}
