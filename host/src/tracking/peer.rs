//! The peer's moves beside ours.

use super::error::TrackingError;
use super::figures::{Judged, MoveRow, PeerGains, PeerRow};
use super::kit::on_all;
use super::linuxcnc::PidParams;
use super::linuxcnc::bench::Bench;
use super::linuxcnc::margins::Margins;
use super::linuxcnc::tunings::{Reference, Tuning};
use super::moves::setpoints;
use super::scene::Scene;
use super::trace::MoveFigures;
use crate::parallel;

/// Most that our peak may be of the peer's: nominal, and off nominal.
const RATIOS: [f64; 2] = [0.2, 1.0 / 15.0];

/// What a tuning has in hand on the nominal machine.
pub fn gains(tuning: &Tuning) -> PeerGains {
    let nominal = Scene::of_moves()[1].nominal;
    let margins = Margins::of(&tuning.params, &nominal.drive);
    PeerGains::new(tuning.name, &tuning.params, &margins)
}

/// The peer on the scenes of the moves, and how ours compare.
pub fn peer(moves: &[MoveRow], tunings: &[Tuning]) -> Result<Vec<PeerRow>, TrackingError> {
    let scenes = Scene::of_moves();
    let courses = parallel::map(&scenes, setpoints);
    let courses = courses.into_iter().collect::<Result<Vec<_>, _>>()?;
    let course_of = |scene: &Scene| {
        let same = scenes
            .iter()
            .position(|one| one.name == scene.name && one.feed_mm_per_min == scene.feed_mm_per_min);
        &courses[same.unwrap_or_default()]
    };
    let follow =
        |params: &PidParams, scene: &Scene, seed: u64| -> Result<MoveFigures, TrackingError> {
            let bench = Bench::new(&scene.nominal, &scene.machine(), seed)?;
            Ok(MoveFigures::of(&bench.follow(params, course_of(scene))))
        };
    let mut rows = Vec::new();
    for tuning in tunings {
        let done = on_all(&scenes, |scene, seed| follow(&tuning.params, scene, seed))?;
        for ((scene, all), ours) in scenes.iter().zip(&done).zip(moves) {
            let figures = MoveFigures::worst(all);
            let ratio = ours.figures.peak / figures.peak;
            let [nominal, off_nominal] = RATIOS;
            let limit = match (tuning.reference, scene.name, scene.actual == (1.0, 1.0)) {
                (Reference::Judged, _, false) => Some(off_nominal),
                (Reference::Judged, "full", true) => Some(nominal),
                _ => None,
            };
            rows.push(PeerRow {
                tuning: tuning.name,
                machine: scene.name,
                feed_mm_per_min: scene.feed_mm_per_min,
                figures,
                ratio,
                judged: limit.map(|limit| Judged::new(ratio, limit)),
            });
        }
    }
    Ok(rows)
}
