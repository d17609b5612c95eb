//! What identification found of the machines, beside what they have.

use leadscrew::tuning::DriveModel;

use super::error::TrackingError;
use super::figures::{IdentifiedFigure, IdentifiedRow};
use super::kit::{Kit, SEEDS};
use super::scene::Scene;
use super::tuned::{Cold, model_of};

/// A figure: name, unit, its size in the unit, and whether it was seen at all.
type Column = (
    &'static str,
    &'static str,
    fn(&DriveModel) -> f64,
    fn(&Cold) -> bool,
);

/// Always seen.
const SEEN: fn(&Cold) -> bool = |_| true;

/// Figures of the table.
const COLUMNS: [Column; 10] = [
    (
        "gain",
        "mm/min",
        |model| model.full_command_feed_mm_per_min,
        SEEN,
    ),
    ("period", "ms", |model| 1e3 * model.natural_period_s, SEEN),
    ("damping", "1", |model| model.damping, SEEN),
    ("delay", "ms", |model| 1e3 * model.delay_s, SEEN),
    ("dead time", "ms", |model| 1e3 * model.dead_time_s, SEEN),
    ("offset", "%", |model| 1e2 * model.offset, SEEN),
    (
        "friction",
        "mm/min",
        |model| model.friction_forward_mm_per_min,
        SEEN,
    ),
    (
        "static",
        "mm/min",
        |model| model.breakaway_forward_mm_per_min,
        |cold| cold.identified.breakaway.iter().all(Option::is_some),
    ),
    (
        "Stribeck",
        "mm/min",
        |model| model.stribeck_mm_per_min,
        |cold| cold.identified.stribeck.is_some(),
    ),
    ("limit", "m/s2", |model| model.max_acceleration_m_s2, SEEN),
];

/// A row for each machine that the scenes tune on.
pub fn identified(kit: &Kit, scenes: &[Scene]) -> Result<Vec<IdentifiedRow>, TrackingError> {
    let mut rows: Vec<IdentifiedRow> = Vec::new();
    let mut done: Vec<&Scene> = Vec::new();
    for scene in scenes {
        if done.iter().all(|other| other.nominal != scene.nominal) {
            done.push(scene);
            let cold = SEEDS.map(|seed| kit.cold(&scene.nominal, seed));
            let cold = cold.into_iter().collect::<Result<Vec<&Cold>, _>>()?;
            let truth = model_of(&scene.nominal);
            let figures = COLUMNS.iter().map(|column| figure(column, &truth, &cold));
            rows.push(IdentifiedRow {
                machine: scene.name,
                figures: figures.collect(),
            });
        }
    }
    Ok(rows)
}

fn figure(
    (figure, unit, of, seen): &Column,
    truth: &DriveModel,
    all: &[&Cold],
) -> IdentifiedFigure {
    let truth = of(truth);
    let found = all.iter().filter(|cold| seen(cold));
    let values: Vec<f64> = found.map(|cold| of(&cold.identified.model())).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let off = |value: &f64| (value - truth).abs();
    IdentifiedFigure {
        figure,
        unit,
        truth,
        mean: (!values.is_empty()).then_some(mean),
        worst: values.iter().map(off).reduce(f64::max),
    }
}
