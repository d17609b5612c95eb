//! Figures of a run, for people and programs.

use std::collections::BTreeMap;

use leadscrew::estimator::EstimatorConfig;
use serde::Serialize;

use crate::fault_names::fault_name;
use crate::report::{CaptureFigures, LagFigures, figure_or_dash, text_table};
use crate::simulation::{Accuracy, Listener, Run, RunSpec};
use crate::statistics::Spread;
use crate::tacho_watch::{Watched, describe};

/// The report of a run.
#[derive(Serialize)]
pub(super) struct Report {
    schema: &'static str,
    machine: String,
    move_mm: f64,
    feed_mm_per_min: f64,
    tick_hz: f64,
    seed: u64,
    estimator: &'static str,
    ticks: usize,
    digest: String,
    units: Units,
    following_error: FollowingError,
    estimators: BTreeMap<&'static str, EstimatorFigures>,
    /// What stopped the axis; null where nothing did.
    fault: Option<FaultFigures>,
    capture: CaptureFigures,
    tachogenerator: TachogeneratorFigures,
    /// Of the tachogenerator; empty if there is none.
    #[serde(skip)]
    warning: String,
}

/// The fault that stopped the axis.
#[derive(Serialize)]
struct FaultFigures {
    number: u8,
    name: &'static str,
    at_tick: u32,
}

impl FaultFigures {
    fn of(run: &Run) -> Option<Self> {
        run.ticks.iter().find_map(|tick| {
            let fault = tick.outputs.fault?;
            Some(Self {
                number: fault as u8,
                name: fault_name(fault),
                at_tick: tick.outputs.tick,
            })
        })
    }

    fn text(&self) -> String {
        let Self {
            number,
            name,
            at_tick,
        } = self;
        format!(
            "warning: fault {number} ({name}) stopped the axis at tick {at_tick}; docs/faults.md tells why and what to do\n"
        )
    }
}

/// What the tachogenerator said of the encoder, by the estimator in the loop.
#[derive(Serialize)]
struct TachogeneratorFigures {
    /// Fitted: tachogenerator over encoder.
    gain: f64,
    /// Fitted, d/tick.
    offset: f64,
    /// False if the axis has not moved for long enough to know the gain.
    is_learned: bool,
    /// Rms over the run, d/tick.
    residual_rms: f64,
    /// At the end; null if the two agree.
    disagreement: Option<&'static str>,
    /// First tick of a disagreement; null without one.
    disagreed_at_tick: Option<u32>,
    /// Times that one began.
    disagreements: u32,
}

impl From<&Watched> for TachogeneratorFigures {
    fn from(watched: &Watched) -> Self {
        Self {
            gain: watched.gain,
            offset: watched.offset,
            is_learned: watched.is_learned,
            residual_rms: watched.residual.rms(),
            disagreement: watched.disagreement.map(|found| describe(found).0),
            disagreed_at_tick: watched.first_tick,
            disagreements: watched.disagreements,
        }
    }
}

impl TachogeneratorFigures {
    fn text(&self) -> String {
        let learned = if self.is_learned {
            ""
        } else {
            " (moved too little to know them)"
        };
        format!(
            "tachogenerator over encoder: gain {:.4}, offset {:.3} d/tick{learned}, residual rms {:.3} d/tick\n",
            self.gain, self.offset, self.residual_rms
        )
    }
}

#[derive(Serialize)]
struct Units {
    position: &'static str,
    velocity: &'static str,
    acceleration: &'static str,
    lag: &'static str,
}

#[derive(Serialize)]
struct FollowingError {
    peak: f64,
    rms: f64,
    at_end: f64,
}

/// Errors of an estimator against the truth at its own instant, while a move runs; null where none did.
#[derive(Serialize)]
struct EstimatorFigures {
    velocity_error_rms: Option<f64>,
    acceleration_error_rms: Option<f64>,
    tachogenerator_difference_rms: Option<f64>,
    #[serde(flatten)]
    lags: LagFigures,
}

impl EstimatorFigures {
    fn new(config: &EstimatorConfig, accuracy: &Accuracy) -> Self {
        Self {
            velocity_error_rms: accuracy.velocity.rms_of_some(),
            acceleration_error_rms: accuracy.acceleration.rms_of_some(),
            tachogenerator_difference_rms: accuracy.against_tachogenerator.rms_of_some(),
            lags: config.into(),
        }
    }
}

impl Report {
    /// The report of `run`, which `spec` asked for on the machine called `machine`.
    pub(super) fn new(machine: &str, spec: &RunSpec, run: &Run) -> Self {
        let error: Spread = run.following_error();
        let at_end = run
            .ticks
            .last()
            .map_or(0.0, |tick| tick.outputs.following_error.to_num());
        let figures = |listener: &Listener| {
            (
                listener.config.name(),
                EstimatorFigures::new(&listener.config, &run.accuracy(listener)),
            )
        };
        Self {
            schema: "leadscrew/sim/1",
            machine: machine.to_owned(),
            move_mm: spec.scenario.move_mm,
            feed_mm_per_min: spec.scenario.feed_mm_per_min,
            tick_hz: spec.scenario.tick_hz,
            seed: spec.seed,
            estimator: spec.estimator.name(),
            ticks: run.ticks.len(),
            digest: format!("{:016x}", run.digest),
            units: Units {
                position: "d",
                velocity: "d/tick",
                acceleration: "d/tick²",
                lag: "tick",
            },
            following_error: FollowingError {
                peak: error.peak(),
                rms: error.rms(),
                at_end,
            },
            estimators: run.listeners.iter().map(figures).collect(),
            fault: FaultFigures::of(run),
            capture: run.health.into(),
            tachogenerator: (&run.watched).into(),
            warning: run.watched.warning(),
        }
    }

    /// The report for people.
    pub(super) fn to_text(&self) -> String {
        let mut table = text_table(&[
            "estimator",
            "rms v\nd/tick",
            "rms a\nd/tick²",
            "tacho\nd/tick",
            "lag x/v/a\nticks",
        ]);
        for (name, figures) in &self.estimators {
            table.add_row([
                (*name).to_owned(),
                figure_or_dash(figures.velocity_error_rms, 4),
                figure_or_dash(figures.acceleration_error_rms, 4),
                figure_or_dash(figures.tachogenerator_difference_rms, 4),
                figures.lags.to_string(),
            ]);
        }
        format!(
            "{}: {} mm at {} mm/min and back, {} Hz, {} in the loop, seed {}\n\
             {} ticks, digest {}\n\
             following error, d: peak {:.1}, rms {:.2}, at the end {:.1}\n\
             {}rms v, rms a: rms errors over the move, ramps included, seed {}\n{}{}{}\n\
             {}\n",
            self.machine,
            self.move_mm,
            self.feed_mm_per_min,
            self.tick_hz,
            self.estimator,
            self.seed,
            self.ticks,
            self.digest,
            self.following_error.peak,
            self.following_error.rms,
            self.following_error.at_end,
            self.tachogenerator.text(),
            self.seed,
            self.fault
                .as_ref()
                .map_or_else(String::new, FaultFigures::text),
            self.capture.warnings(),
            self.warning,
            table.trim_fmt(),
        )
    }
}
