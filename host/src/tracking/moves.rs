//! Our axis there and back.

use leadscrew::encoder_map::EncoderMap;
use leadscrew::params::AxisParams;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::MachineParams;

use super::error::TrackingError;
use super::figures::{Judged, MoveRow};
use super::kit::{Kit, on_all};
use super::rig::Rig;
use super::runs;
use super::scene::{MOVE_MM, Scene};
use super::trace::{MoveFigures, Trace};
use super::tuned::tuned_on;
use crate::calibration::{Procedure, learn_simulated};

/// Peaks of our moves to reach, d, in the order of the scenes, and what would be better still.
const PEAKS: [Option<(f64, f64)>; 5] = [
    Some((10.0, 2.0)),
    Some((20.0, 5.0)),
    None,
    Some((40.0, 10.0)),
    Some((40.0, 10.0)),
];
/// Largest standing error, d.
const STANDING: f64 = 1.0;

fn there_and_back(
    params: &AxisParams,
    machine: &MachineParams,
    map: Option<EncoderMap<'_>>,
    seed: u64,
    feed_mm_per_min: f64,
) -> Result<Trace, TrackingError> {
    let mut rig = Rig::new(machine, params, map, seed)?;
    runs::there_and_back(&mut rig, MOVE_MM, feed_mm_per_min)
}

/// Setpoints of the move at the feed of a scene.
///
/// # Errors
/// Never with the scenes built in.
pub fn setpoints(scene: &Scene) -> Result<Vec<f64>, TrackingError> {
    let image = learn_simulated(&EncoderModel::real(), 1, &Procedure::default())?;
    let map = Some(EncoderMap::from_bytes(&image)?);
    let bare = Scene::bare().nominal;
    let (params, _) = tuned_on(&bare)?;
    let trace = there_and_back(&params, &bare, map, 1, scene.feed_mm_per_min)?;
    Ok(trace.iter().map(|tick| tick.setpoint).collect())
}

/// The worst of the encoders on each scene, with `params` of scene and seed.
fn worst_moves(
    scenes: &[Scene],
    params: impl Fn(&Scene, u64) -> Result<AxisParams, TrackingError> + Sync,
    kit: &Kit,
) -> Result<Vec<MoveFigures>, TrackingError> {
    let done = on_all(scenes, |scene, seed| {
        let (params, machine) = (params(scene, seed)?, scene.machine());
        let map = kit.map(&machine, seed)?;
        let trace = there_and_back(&params, &machine, map, seed, scene.feed_mm_per_min)?;
        Ok(MoveFigures::of(&trace))
    })?;
    Ok(done.iter().map(|all| MoveFigures::worst(all)).collect())
}

/// Bare, full, and off nominal.
pub fn moves(kit: &Kit) -> Result<Vec<MoveRow>, TrackingError> {
    let scenes = Scene::of_moves();
    let figures = worst_moves(&scenes, cold(kit), kit)?;
    let row = |((scene, figures), limits): ((&Scene, MoveFigures), Option<(f64, f64)>)| {
        let judged = |limit| Judged::new(figures.peak, limit);
        MoveRow {
            machine: scene.name,
            feed_mm_per_min: scene.feed_mm_per_min,
            figures,
            peak: limits.map(|(limit, _)| judged(limit)),
            quiet: limits.map(|_| figures.is_quiet()),
            standing: limits.map(|_| Judged::new(figures.standing_peak, STANDING)),
            moonshot: limits.map(|(_, moonshot)| judged(moonshot)),
        }
    };
    Ok(scenes.iter().zip(figures).zip(PEAKS).map(row).collect())
}

/// The full machine with its backlashes.
pub fn backlash(kit: &Kit) -> Result<Vec<MoveRow>, TrackingError> {
    let scenes = Scene::with_backlash();
    let figures = worst_moves(&scenes, cold(kit), kit)?;
    let row = |(index, (scene, figures)): (usize, (&Scene, MoveFigures))| {
        // Backlash inside the loop makes a limit cycle whatever the law: it is shown.
        let is_judged = index < 2;
        MoveRow {
            machine: scene.name,
            feed_mm_per_min: scene.feed_mm_per_min,
            figures,
            peak: None,
            quiet: is_judged.then(|| figures.is_quiet()),
            standing: is_judged.then(|| Judged::new(figures.standing_peak, STANDING)),
            moonshot: None,
        }
    };
    Ok(scenes.iter().zip(figures).enumerate().map(row).collect())
}

/// A row that is shown beside those that are judged.
fn shown((scene, figures): (&Scene, MoveFigures)) -> MoveRow {
    MoveRow {
        machine: scene.name,
        feed_mm_per_min: scene.feed_mm_per_min,
        figures,
        peak: None,
        quiet: None,
        standing: None,
        moonshot: None,
    }
}

/// The scenes of the moves by an axis that was tuned on its drive's true figures.
pub fn known(kit: &Kit) -> Result<Vec<MoveRow>, TrackingError> {
    let scenes = Scene::of_moves();
    let figures = worst_moves(&scenes, |scene, _| Ok(tuned_on(&scene.nominal)?.0), kit)?;
    Ok(scenes.iter().zip(figures).map(shown).collect())
}

/// The off nominal machines by axes that were commissioned on them.
pub fn there(kit: &Kit) -> Result<Vec<MoveRow>, TrackingError> {
    let scenes = Scene::commissioned_off_nominal();
    let figures = worst_moves(&scenes, cold(kit), kit)?;
    Ok(scenes.iter().zip(figures).map(shown).collect())
}

/// Parameters from cold, of the scene's nominal machine with the encoder of the seed.
fn cold(kit: &Kit) -> impl Fn(&Scene, u64) -> Result<AxisParams, TrackingError> + Sync {
    |scene, seed| Ok(kit.cold(&scene.nominal, seed)?.params)
}
