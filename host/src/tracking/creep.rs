//! Slow feeds, near the drive's own resolution.

use super::error::TrackingError;
use super::figures::{CreepRow, Judged};
use super::kit::{Kit, on_all};
use super::rig::Rig;
use super::runs;
use super::scene::Scene;
use super::trace::{Trace, errors};
use crate::statistics::Spread;

/// Largest error of a creep, d.
const CREEP: f64 = 1.0;
/// Its feeds, mm/min, and its way, mm.
const CREEP_MM_PER_MIN: [f64; 2] = [1.0, -1.0];
const CREEP_MM: f64 = 0.3;
/// What is taken for its start, ticks.
const CREEP_START: usize = 1000;

/// Creeps both ways.
pub fn creep(kit: &Kit) -> Result<Vec<CreepRow>, TrackingError> {
    let scenes = [Scene::of_moves()[1], Scene::bare()];
    let mut rows = Vec::new();
    for feed in CREEP_MM_PER_MIN {
        let done = on_all(&scenes, |scene, seed| {
            let machine = scene.machine();
            let params = &kit.cold(&scene.nominal, seed)?.params;
            let map = kit.map(&machine, seed)?;
            let way = CREEP_MM.copysign(feed);
            let mut rig = Rig::new(&machine, params, map, seed)?;
            let trace = runs::feed(&mut rig, way, feed.abs())?;
            Ok(CreepErrors::of(&trace))
        })?;
        for (scene, all) in scenes.iter().zip(&done) {
            let largest = |of: fn(&CreepErrors) -> f64| all.iter().map(of).fold(0.0, f64::max);
            rows.push(CreepRow {
                machine: scene.name,
                feed_mm_per_min: feed,
                start_peak: largest(|errors| errors.start_peak),
                peak: Judged::new(largest(|errors| errors.peak), CREEP),
                rms: largest(|errors| errors.rms),
            });
        }
    }
    Ok(rows)
}

/// Errors of a creep, d.
struct CreepErrors {
    start_peak: f64,
    peak: f64,
    rms: f64,
}

impl CreepErrors {
    fn of(trace: &Trace) -> Self {
        let errors = errors(trace);
        let begin = trace
            .windows(2)
            .position(|pair| pair[0].setpoint != pair[1].setpoint)
            .unwrap_or_default();
        let (start, creep) = errors[begin..].split_at(CREEP_START.min(errors.len() - begin));
        let of = |errors: &[f64]| errors.iter().copied().collect::<Spread>();
        Self {
            start_peak: of(start).peak(),
            peak: of(creep).peak(),
            rms: of(creep).rms(),
        }
    }
}
