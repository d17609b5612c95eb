//! Identified figures beside those of the machine, for people and programs.

use leadscrew::identification::{Figure, Identified, LargestAcceleration};
use leadscrew::units::AxisScale;
use leadscrew_hal_mock::drive::DriveParams;
use serde::Serialize;

use crate::axis::IdentifiedAxis;
use crate::cli::BenchArgs;
use crate::identify::{Bench, Found};
use crate::report::{self, text_table};

/// The report of an identification.
#[derive(Serialize)]
pub(in crate::command) struct Report {
    schema: &'static str,
    machine: String,
    tick_hz: f64,
    window_mm: f64,
    /// Null for an axis.
    seed: Option<u64>,
    polarity: &'static str,
    proof_level: f64,
    duration_s: f64,
    furthest_mm: f64,
    residual_d: f64,
    figures: Vec<Row>,
}

/// A figure in the units of the shop floor, beside the machine's.
#[derive(Serialize)]
struct Row {
    name: &'static str,
    unit: &'static str,
    /// Null for what was not seen.
    value: Option<f64>,
    /// Null for what was not seen, and for bounds.
    sigma: Option<f64>,
    /// The figure is the least that it can be.
    at_least: bool,
    /// What the simulated machine has; null for an axis.
    truth: Option<f64>,
}

impl Row {
    fn new(
        name: &'static str,
        unit: &'static str,
        figure: Figure,
        factor: f64,
        truth: f64,
    ) -> Self {
        Self::of(name, unit, Some(figure), factor, truth)
    }

    fn of(
        name: &'static str,
        unit: &'static str,
        figure: Option<Figure>,
        factor: f64,
        truth: f64,
    ) -> Self {
        Self {
            name,
            unit,
            value: figure.map(|figure| figure.value * factor),
            sigma: figure.map(|figure| figure.sigma * factor),
            at_least: false,
            truth: Some(truth),
        }
    }

    fn cells(&self) -> Vec<String> {
        let dash = || "-".to_owned();
        let bound = if self.at_least { "≥ " } else { "" };
        let truth = self.truth.map(|truth| format!("{truth:.4}"));
        let found = [
            self.name.to_owned(),
            self.value
                .map_or_else(dash, |value| format!("{bound}{}", decimal(value))),
            self.sigma.map_or_else(dash, |sigma| format!("{sigma:.4}")),
        ];
        let unit = self.unit.to_owned();
        found.into_iter().chain(truth).chain([unit]).collect()
    }
}

impl Report {
    /// The report of `found` on `bench`, which `args` asked for.
    pub fn new(args: &BenchArgs, bench: &Bench, found: &Found) -> Self {
        Self {
            schema: "leadscrew/identify/1",
            machine: args.simulated.machine.clone(),
            tick_hz: bench.tick_hz,
            window_mm: bench.params.window_mm,
            seed: Some(bench.seed),
            polarity: "right",
            proof_level: found.identified.proof_level,
            duration_s: found.duration_s,
            furthest_mm: found.furthest_mm,
            residual_d: found.identified.residual_d,
            figures: rows(&found.identified, &bench.machine.drive),
        }
    }

    /// The report of what was `found` on the axis at `port`.
    pub fn of_axis(port: &str, tick_hz: f64, window_mm: f64, found: &IdentifiedAxis) -> Self {
        // What a machine has is known of simulated ones.
        let figures = rows(&found.identified, &DriveParams::default());
        let untold = |row| Row { truth: None, ..row };
        Self {
            schema: "leadscrew/identify/1",
            machine: port.to_owned(),
            tick_hz,
            window_mm,
            seed: None,
            polarity: "right",
            proof_level: found.identified.proof_level,
            duration_s: found.duration_s,
            furthest_mm: found.furthest_mm,
            residual_d: found.identified.residual_d,
            figures: figures.into_iter().map(untold).collect(),
        }
    }

    /// The report for people.
    pub fn to_text(&self) -> String {
        let (columns, seed) = match self.seed {
            Some(seed) => (
                &["figure", "identified", "1σ", "machine", "unit"][..],
                format!(", seed {seed}"),
            ),
            None => (&["figure", "identified", "1σ", "unit"][..], String::new()),
        };
        let mut table = text_table(columns);
        for row in &self.figures {
            table.add_row(row.cells());
        }
        format!(
            "{}: {:.1} s of experiments at {} Hz within {:.1} mm of the start (window {} mm){}\n\
             polarity: right, proved at {:.1} % of full command\n\
             measured less modelled position: {:.2} d rms\n\
             {}\n",
            self.machine,
            self.duration_s,
            self.tick_hz,
            self.furthest_mm,
            self.window_mm,
            seed,
            100.0 * self.proof_level,
            self.residual_d,
            table.trim_fmt(),
        )
    }
}

/// All figures, and what the drive of the machine has.
fn rows(found: &Identified, drive: &DriveParams) -> Vec<Row> {
    let feed = feed_per_velocity(found.scale);
    let gain = drive.full_command_feed_mm_per_min;
    let friction = drive.friction_mm_per_min;
    let held = friction * drive.stiction_ratio;
    let offset_feed = drive.offset * gain;
    let [forward, backward] = found.loss;
    let [break_forward, break_backward] = found.breakaway;
    let to_m_s2 = found.acceleration_m_s2(1.0);
    let acceleration = drive.max_acceleration_m_s2;
    let limit = match found.largest_acceleration {
        LargestAcceleration::Reached(figure) => Row::new(
            "largest acceleration",
            "m/s²",
            figure,
            to_m_s2,
            acceleration,
        ),
        LargestAcceleration::AtLeast(value) => Row {
            at_least: true,
            sigma: None,
            ..Row::new(
                "largest acceleration",
                "m/s²",
                Figure { value, sigma: 0.0 },
                to_m_s2,
                acceleration,
            )
        },
    };
    let mm_min = "mm/min";
    vec![
        Row::new("feed per full command", mm_min, found.gain, feed, gain),
        Row::new(
            "feed at full command",
            mm_min,
            found.full_speed,
            feed,
            gain - friction - offset_feed.abs(),
        ),
        Row::new("offset", "%", found.offset, 100.0, 100.0 * drive.offset),
        Row::new(
            "lost forward",
            mm_min,
            forward,
            feed,
            friction - offset_feed,
        ),
        Row::new(
            "lost backward",
            mm_min,
            backward,
            feed,
            friction + offset_feed,
        ),
        Row::new("kinetic friction", mm_min, found.friction, feed, friction),
        Row::of("static forward", mm_min, break_forward, feed, held),
        Row::of("static backward", mm_min, break_backward, feed, held),
        Row::of(
            "Stribeck feed",
            mm_min,
            found.stribeck,
            feed,
            drive.stribeck_mm_per_min,
        ),
        Row::new(
            "natural period",
            "ms",
            found.natural_period_s,
            1e3,
            1e3 * drive.natural_period_s,
        ),
        Row::new("damping", "1", found.damping, 1.0, drive.damping),
        Row::new("delay", "ms", found.delay_s, 1e3, 1e3 * drive.delay_s),
        Row::new(
            "dead time at reversal",
            "ms",
            found.dead_time_s,
            1e3,
            1e3 * drive.dead_time_s,
        ),
        limit,
    ]
}

/// Four decimals.
fn decimal(value: f64) -> String {
    report::decimals(value, 4)
}

/// mm/min of 1 d/tick.
fn feed_per_velocity(scale: AxisScale) -> f64 {
    scale.feed_from_velocity(1.0)
}
