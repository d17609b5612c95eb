//! Figures of a replay, for people and programs.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use super::{MapFigures, Replay, Span, Track};
use crate::report::{LagFigures, figure_or_dash, overrun_warning, overspeed_warning, text_table};
use crate::statistics::{Spread, mean, slope};

/// The report of a replay.
#[derive(Serialize)]
pub(super) struct Report {
    schema: &'static str,
    edges: u64,
    illegal: u64,
    final_count: i64,
    ticks: usize,
    tick_hz: f64,
    units: Units,
    estimators: BTreeMap<&'static str, Figures>,
    /// Ticks in which the count moved further than a velocity can tell.
    overspeed_ticks: u32,
    /// Ticks in which edge times were lost.
    overrun_ticks: u32,
    /// Ticks in which the edge times do not explain the count.
    ambiguous_ticks: u32,
    /// The encoder map; null without one.
    map: Option<MapFigures>,
    #[serde(skip)]
    span: String,
}

#[derive(Serialize)]
struct Units {
    final_count: &'static str,
    velocity_peak: &'static str,
    acceleration_rms: &'static str,
    acceleration_fit: &'static str,
    acceleration_mean: &'static str,
    lag: &'static str,
}

/// Figures after warm-up; null where the capture, or the span, ends before it.
#[derive(Serialize)]
struct Figures {
    velocity_peak: Option<f64>,
    acceleration_rms: Option<f64>,
    /// Least-squares slope of the velocity; null for fewer than two ticks.
    acceleration_fit: Option<f64>,
    /// Mean of the estimated acceleration over the same span; null without a tick in it.
    acceleration_mean: Option<f64>,
    /// The model of motion that it ran; null for those without one.
    model: Option<&'static str>,
    #[serde(flatten)]
    lags: LagFigures,
}

/// The model of motion that an estimator of this name runs where no command of the drive is known.
fn model_without_command(estimator: &str) -> Option<&'static str> {
    (estimator == "observer").then_some("kinematic")
}

impl Figures {
    fn new(track: &Track, tick_hz: f64, span: &Span) -> Self {
        let warm_up = track.config.warm_up_ticks() as usize;
        let settled = || track.estimates.iter().enumerate().skip(warm_up);
        let velocity: Spread = settled()
            .map(|(_, estimate)| estimate.velocity.to_num())
            .collect();
        let acceleration: Spread = settled()
            .map(|(_, estimate)| estimate.acceleration.to_num())
            .collect();
        let in_span = || settled().filter(|(tick, _)| span.contains(*tick, tick_hz));
        let points: Vec<_> = in_span()
            .map(|(tick, estimate)| (tick as f64, estimate.velocity.to_num()))
            .collect();
        Self {
            velocity_peak: velocity.peak_of_some(),
            acceleration_rms: acceleration.rms_of_some(),
            acceleration_fit: slope(&points),
            acceleration_mean: mean(
                in_span().map(|(_, estimate)| estimate.acceleration.to_num::<f64>()),
            ),
            model: model_without_command(track.config.name()),
            lags: LagFigures::mean(settled().map(|(_, estimate)| estimate.lags))
                .unwrap_or_else(|| (&track.config).into()),
        }
    }
}

impl Report {
    /// The report of `replay`, with acceleration fitted over `span`.
    pub(super) fn new(replay: &Replay, span: &Span, map: Option<MapFigures>) -> Self {
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
                acceleration_mean: "d/tick²",
                lag: "tick",
            },
            estimators: replay.tracks.iter().map(figures).collect(),
            overspeed_ticks: replay.health.overspeed_ticks,
            overrun_ticks: replay.health.overrun_ticks,
            ambiguous_ticks: replay.health.ambiguous_ticks,
            map,
            span: span.to_string(),
        }
    }

    /// The report for people.
    pub(super) fn to_text(&self, file: &Path) -> String {
        let mut table = text_table(&[
            "estimator",
            "velocity\npeak\nd/tick",
            "acceleration\nrms\nd/tick²",
            "acceleration\nfit\nd/tick²",
            "acceleration\nmean\nd/tick²",
            "lag x/v/a\n\nticks",
        ]);
        for (name, figures) in &self.estimators {
            table.add_row([
                (*name).to_owned(),
                figure_or_dash(figures.velocity_peak, 3),
                figure_or_dash(figures.acceleration_rms, 4),
                figure_or_dash(figures.acceleration_fit, 6),
                figure_or_dash(figures.acceleration_mean, 6),
                figures.lags.to_string(),
            ]);
        }
        format!(
            "{}: {} edges, {} illegal, final count {} d, {} ticks at {} Hz\n\
             {}{}{}acceleration fit, mean: slope of the velocity, mean of the acceleration {}\n\n\
             {}\n",
            file.display(),
            self.edges,
            self.illegal,
            self.final_count,
            self.ticks,
            self.tick_hz,
            self.warnings(),
            self.map
                .as_ref()
                .map(ToString::to_string)
                .unwrap_or_default(),
            self.models(),
            self.span,
            table.trim_fmt(),
        )
    }

    /// Which estimators ran a model of motion, a line each.
    fn models(&self) -> String {
        let line = |(name, figures): (&&str, &Figures)| {
            let model = figures.model?;
            Some(format!("{name}: ran its {model} model\n"))
        };
        self.estimators.iter().filter_map(line).collect()
    }

    /// What makes the figures doubtful, a line each.
    fn warnings(&self) -> String {
        let mut text = String::new();
        if self.edges == 0 {
            text += "warning: A and B never change: choose other channels with --a and --b\n";
        }
        if self.illegal > 0 {
            text += "warning: A and B changed at once, so counts were lost: capture at a higher sample rate\n";
        }
        text + &overrun_warning(self.overrun_ticks) + &overspeed_warning(self.overspeed_ticks)
    }
}
