//! Threads on the bare and the full machine.

use leadscrew_hal_mock::encoder::EncoderModel;

use super::error::TrackingError;
use super::figures::{Judged, ThreadPass, Threads};
use super::kit::Kit;
use super::scene::Scene;
use crate::parallel;
use crate::threads::{Lathe, ThreadRow, ThreadTable};

/// Most that two passes may differ in phase, °.
const PHASE_SPREAD_DEG: f64 = 0.1;
/// Largest pitch error over 100 mm, d.
const PITCH_ERROR: f64 = 2.0;
/// Passes at each speed.
const PASSES: u32 = 3;
/// What draws the errors of both encoders.
const SEED: u64 = 1;

/// Cuts the threads by the axes commissioned from cold, with the learned map.
pub fn threads(kit: &Kit) -> Result<Vec<Threads>, TrackingError> {
    let [bare, full, ..] = Scene::of_moves();
    let done = parallel::map(&[bare, full], |scene| {
        let machine = scene.machine();
        let params = &kit.cold(&scene.nominal, SEED)?.params;
        let map = kit.map(&machine, SEED)?;
        let table = ThreadTable::cut_by(machine.mount.counts_per_mm, PASSES, |spindle| {
            Lathe::with(params, map, &machine, spindle, EncoderModel::real(), SEED)
        })?;
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
