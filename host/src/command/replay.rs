//! `leadscrew replay`: the core on a capture of a real encoder.

use std::collections::BTreeMap;
use std::path::Path;

use leadscrew::capture::Unwrapper;
use leadscrew::estimator::{Estimate, Estimator, EstimatorConfig};
use serde::Serialize;

use super::{estimator, print, print_json, tick_rate, write_file};
use crate::cli::ReplayArgs;
use crate::error::CommandError;
use crate::figures::{self, acceleration_points, estimator_series, panel, velocity_points};
use crate::plot::Figure;
use crate::progress::Progress;
use crate::recording::{self, ChannelSelection, Recording};
use crate::report::{CsvReport, LagFigures};
use crate::sampler::{Sampler, Totals};
use crate::simulation::all_estimators;
use crate::statistics::{Spread, slope};

/// The estimator of the CSV where none is asked for.
const DEFAULT_ESTIMATOR: &str = "exponential";

/// Runs the command.
///
/// # Errors
/// Bad usage, a capture that cannot be read, or a file that cannot be written.
pub fn run(args: &ReplayArgs) -> Result<(), CommandError> {
    let tick_hz = tick_rate(args.tick_hz)?;
    let configs = match &args.estimator {
        Some(name) => vec![estimator(name)?],
        None => all_estimators(),
    };
    let span = Span::new(args)?;
    let channels = ChannelSelection {
        a: args.a.clone(),
        b: args.b.clone(),
        z: args.z.clone(),
    };
    let recording = recording::read(&args.file, &channels, args.samplerate)?;
    let replay = Replay::of(&recording, tick_hz, &configs);

    if let Some(path) = &args.output.csv {
        replay.write_csv(path)?;
    }
    if let Some(path) = &args.output.plot {
        replay.figure(&args.file).save(path)?;
    }
    let report = Report::new(&replay, &span);
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
    counts: Vec<i64>,
    tracks: Vec<Track>,
}

/// The estimates of one estimator.
struct Track {
    config: EstimatorConfig,
    estimates: Vec<Estimate>,
}

impl Replay {
    fn of(recording: &Recording, tick_hz: f64, configs: &[EstimatorConfig]) -> Self {
        let mut sampler = Sampler::new(recording, tick_hz);
        let mut progress = Progress::new("replaying", sampler.ticks());
        let mut unwrapper = Unwrapper::new();
        let mut estimators: Vec<_> = configs
            .iter()
            .map(|&config| Estimator::new(config))
            .collect();
        let track = |&config: &EstimatorConfig| Track {
            config,
            estimates: Vec::new(),
        };
        let mut tracks: Vec<_> = configs.iter().map(track).collect();
        let mut counts = Vec::new();
        while let Some(capture) = sampler.next_capture() {
            let observation = unwrapper.unwrap(&capture);
            counts.push(observation.count);
            for (estimator, track) in estimators.iter_mut().zip(&mut tracks) {
                track.estimates.push(estimator.update(&observation));
            }
            progress.step();
        }
        Self {
            tick_hz,
            totals: sampler.totals(),
            counts,
            tracks,
        }
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
            let mut report = CsvReport::new(file, self.tick_hz, track.config, &[])?;
            for (tick, (estimate, count)) in track.estimates.iter().zip(&self.counts).enumerate() {
                report.row(tick as u64, *count, estimate, &[])?;
            }
            report.finish()
        })
    }

    fn figure(&self, file: &Path) -> Figure {
        let name = file
            .file_name()
            .unwrap_or(file.as_os_str())
            .to_string_lossy();
        let curves = |points: Curve| {
            let series = |(index, track): (usize, &Track)| {
                estimator_series(
                    index,
                    track.config.name(),
                    points(&track.estimates, self.tick_hz),
                )
            };
            self.tracks.iter().enumerate().map(series).collect()
        };
        Figure::new(
            format!("{name} at {} Hz", self.tick_hz),
            vec![
                panel(figures::VELOCITY, curves(velocity_points)),
                panel(figures::ACCELERATION, curves(acceleration_points)),
            ],
        )
    }
}

/// The span of time over which acceleration is fitted.
struct Span {
    from_s: Option<f64>,
    to_s: f64,
}

impl Span {
    fn new(args: &ReplayArgs) -> Result<Self, CommandError> {
        let (from, to) = (
            args.from_s.unwrap_or(0.0),
            args.to_s.unwrap_or(f64::INFINITY),
        );
        if from >= 0.0 && from < to {
            Ok(Self {
                from_s: args.from_s,
                to_s: to,
            })
        } else {
            Err(CommandError::Usage(format!(
                "--from-s {from} --to-s {to}: the span must begin at 0 or later and end after its beginning"
            )))
        }
    }

    /// The ticks of the span, after warm-up.
    fn contains(&self, tick: usize, tick_hz: f64, warm_up: u32) -> bool {
        let time = tick as f64 / tick_hz;
        let begun = self
            .from_s
            .map_or(tick >= warm_up as usize, |from| time >= from);
        begun && time <= self.to_s
    }
}

#[derive(Serialize)]
struct Report {
    schema: &'static str,
    edges: u64,
    illegal: u64,
    final_count: i64,
    ticks: usize,
    tick_hz: f64,
    units: Units,
    estimators: BTreeMap<&'static str, Figures>,
}

#[derive(Serialize)]
struct Units {
    final_count: &'static str,
    velocity_peak: &'static str,
    acceleration_rms: &'static str,
    acceleration_fit: &'static str,
    lag: &'static str,
}

#[derive(Serialize)]
struct Figures {
    velocity_peak: f64,
    acceleration_rms: f64,
    /// Least-squares slope of the velocity; null where the span holds fewer than two ticks.
    acceleration_fit: Option<f64>,
    #[serde(flatten)]
    lags: LagFigures,
}

impl Figures {
    fn new(track: &Track, tick_hz: f64, span: &Span) -> Self {
        let warm_up = track.config.warm_up_ticks();
        let settled = || track.estimates.iter().enumerate().skip(warm_up as usize);
        let velocity: Spread = settled()
            .map(|(_, estimate)| estimate.velocity.to_num())
            .collect();
        let acceleration: Spread = settled()
            .map(|(_, estimate)| estimate.acceleration.to_num())
            .collect();
        let points: Vec<_> = track
            .estimates
            .iter()
            .enumerate()
            .filter(|(tick, _)| span.contains(*tick, tick_hz, warm_up))
            .map(|(tick, estimate)| (tick as f64, estimate.velocity.to_num()))
            .collect();
        Self {
            velocity_peak: velocity.peak(),
            acceleration_rms: acceleration.rms(),
            acceleration_fit: slope(&points),
            lags: (&track.config).into(),
        }
    }
}

impl Report {
    fn new(replay: &Replay, span: &Span) -> Self {
        let figures = |track: &Track| {
            (
                track.config.name(),
                Figures::new(track, replay.tick_hz, span),
            )
        };
        Self {
            schema: "leadscrew/replay/1",
            edges: replay.totals.edges,
            illegal: replay.totals.illegal,
            final_count: replay.totals.final_count,
            ticks: replay.counts.len(),
            tick_hz: replay.tick_hz,
            units: Units {
                final_count: "d",
                velocity_peak: "d/tick",
                acceleration_rms: "d/tick²",
                acceleration_fit: "d/tick²",
                lag: "tick",
            },
            estimators: replay.tracks.iter().map(figures).collect(),
        }
    }

    fn to_text(&self, file: &Path) -> String {
        let mut text = format!(
            "{}: {} edges, {} illegal, final count {} d, {} ticks at {} Hz\n",
            file.display(),
            self.edges,
            self.illegal,
            self.final_count,
            self.ticks,
            self.tick_hz
        );
        for (name, figures) in &self.estimators {
            let fit = figures
                .acceleration_fit
                .map_or_else(|| "-".to_owned(), |fit| format!("{fit:.6}"));
            text += &format!(
                "{name:12} velocity peak {:.3} d/tick, acceleration rms {:.4} fit {fit} d/tick², lags {:.2} {:.2} {:.2} ticks\n",
                figures.velocity_peak,
                figures.acceleration_rms,
                figures.lags.lag_x_ticks,
                figures.lags.lag_v_ticks,
                figures.lags.lag_a_ticks,
            );
        }
        text
    }
}
