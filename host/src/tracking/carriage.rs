//! The carriage before and after compensation: backlash of variant (a) and the screw's error.

use leadscrew::estimator::{EstimatorConfig, simple};
use leadscrew_hal_mock::scenario::{BANDWIDTH_RAD_PER_S, tuned_axis};

use super::error::TrackingError;
use super::figures::{CarriageRow, Judged};
use super::kit::Kit;
use super::scene::{Scene, TICK_HZ};
use crate::parallel;
use crate::screw::{BeforeAndAfter, ScrewCase, ScrewFailure};

/// Largest positioning error over the travel, and largest reversal error, d.
const POSITIONING: f64 = 2.0;
const REVERSAL: f64 = 1.0;
/// Travel, mm, points of its table, and rest before a reading, s.
const TRAVEL_MM: f64 = 300.0;
const POINTS: usize = 256;
const SETTLE_S: f64 = 0.6;
/// Times that each point is measured from either side.
const RUNS: usize = 3;
/// Largest feed of the axis that counts, mm/min.
const MAX_FEED_MM_PER_MIN: f64 = 9000.0;
/// What draws the machine's errors.
const SEED: u64 = 1;

/// Measures the screw by each drive.
pub fn carriage(kit: &Kit) -> Result<Vec<CarriageRow>, TrackingError> {
    let [outside, ..] = Scene::with_backlash();
    let full = outside.nominal;
    let mut bare = Scene::bare().nominal;
    bare.carriage = full.carriage;
    let counting = EstimatorConfig::Simple(simple::Config::new(15)?);
    let counting = tuned_axis(
        &bare,
        TICK_HZ,
        MAX_FEED_MM_PER_MIN,
        BANDWIDTH_RAD_PER_S,
        counting,
    )?;
    let cases = [
        ("bare drive, loop on the count", bare, counting, None),
        (
            "full, autotuned",
            full,
            kit.cold(&full, SEED)?.params,
            kit.map(&full, SEED)?,
        ),
    ];
    let done = parallel::map(&cases, |(name, machine, axis, map)| {
        let case = ScrewCase {
            machine: *machine,
            axis: *axis,
            map: *map,
            seed: SEED,
            travel_mm: TRAVEL_MM,
            points: POINTS,
            runs: RUNS,
            settle_s: SETTLE_S,
        };
        match case.run() {
            Ok(figures) => CarriageRow::new(name, &figures),
            Err(failure) => CarriageRow::refused(name, &failure),
        }
    });
    Ok(done)
}

impl CarriageRow {
    fn new(machine: &'static str, figures: &BeforeAndAfter) -> Self {
        let BeforeAndAfter {
            before,
            backlash,
            after,
            ..
        } = figures;
        Self {
            machine,
            positioning_before: before.positioning,
            positioning: Judged::new(after.positioning, POSITIONING),
            reversal_before: before.reversal,
            reversal: Judged::new(after.reversal, REVERSAL),
            mean_reversal_of_backlash: backlash.mean_reversal,
            standing: after.standing,
            refused: None,
        }
    }

    /// No table: a servo that stands off by too much at each reading makes none that could be followed.
    fn refused(machine: &'static str, failure: &ScrewFailure) -> Self {
        Self {
            machine,
            positioning_before: f64::INFINITY,
            positioning: Judged::new(f64::INFINITY, POSITIONING),
            reversal_before: f64::INFINITY,
            reversal: Judged::new(f64::INFINITY, REVERSAL),
            mean_reversal_of_backlash: f64::INFINITY,
            standing: f64::INFINITY,
            refused: Some(failure.to_string()),
        }
    }
}
