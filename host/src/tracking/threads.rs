//! Threads on the bare and the full machine.

use leadscrew_hal_mock::encoder::EncoderModel;

use super::error::TrackingError;
use super::figures::{Judged, ThreadPass, Threads};
use super::scene::Scene;
use crate::parallel;
use crate::threads::{ThreadRow, ThreadTable};

/// Most that two passes may differ in phase, °.
const PHASE_SPREAD_DEG: f64 = 0.1;
/// Largest pitch error over 100 mm, d.
const PITCH_ERROR: f64 = 2.0;
/// Where the poles of the loop are placed, with the observer in it, rad/s.
const BANDWIDTH_RAD_PER_S: f64 = 100.0;
/// Passes at each speed.
const PASSES: u32 = 3;
/// What draws the errors of both encoders.
const SEED: u64 = 1;

/// Cuts the threads.
pub fn threads() -> Result<Vec<Threads>, TrackingError> {
    let [bare, full, ..] = Scene::of_moves();
    let done = parallel::map(&[bare, full], |scene| {
        let machine = scene.machine();
        let encoder = EncoderModel::real();
        let table = ThreadTable::cut(&machine, encoder, BANDWIDTH_RAD_PER_S, PASSES, SEED)?;
        Ok(Threads {
            machine: scene.name,
            passes: table.rows.iter().map(ThreadPass::from).collect(),
            phase_spread_deg: Judged::new(table.phase_spread_deg(), PHASE_SPREAD_DEG),
        })
    });
    done.into_iter().collect()
}

impl From<&ThreadRow> for ThreadPass {
    fn from(row: &ThreadRow) -> Self {
        Self {
            rpm: row.rpm,
            pass: row.pass,
            phase_deg: row.phase_deg,
            instantaneous_d: row.instantaneous_d,
            following_d: row.following_d,
            pitch_error: Judged::new(row.pitch_error_d, PITCH_ERROR),
        }
    }
}
