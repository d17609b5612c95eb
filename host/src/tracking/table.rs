//! The figures: all scenes, all encoders, by our axis and by the peer.

use leadscrew::encoder_map::EncoderMap;
use leadscrew_hal_mock::encoder::EncoderModel;

use super::axis::Rig;
use super::carriage::carriage;
use super::error::TrackingError;
use super::figures::{CreepRow, Figures, Judged, MoveRow, PeerGains, PeerRow};
use super::linuxcnc::PidParams;
use super::linuxcnc::bench::Bench;
use super::linuxcnc::margins::Margins;
use super::linuxcnc::tunings::{Reference, Tuning, tunings};
use super::ours::tuned_on;
use super::scene::{MOVE_MM, Scene};
use super::threads::threads;
use super::trace::{MoveFigures, Trace};
use crate::calibration::{Procedure, learn_simulated};
use crate::parallel;

/// Encoders that a figure is the worst of.
pub const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];
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
/// Most that our peak may be of the peer's: nominal, and off nominal.
const RATIOS: [f64; 2] = [0.2, 1.0 / 15.0];
/// Largest error of a creep, d.
const CREEP: f64 = 1.0;
/// Its feeds, mm/min, and its way, mm.
const CREEP_MM_PER_MIN: [f64; 2] = [1.0, -1.0];
const CREEP_MM: f64 = 0.3;
/// What is taken for its start, ticks.
const CREEP_START: usize = 1000;

/// The encoders' learned maps, in the order of the seeds.
struct Maps(Vec<Vec<u8>>);

impl Maps {
    fn learn() -> Result<Self, TrackingError> {
        let learned = parallel::map(&SEEDS, |seed| {
            learn_simulated(&EncoderModel::real(), *seed, &Procedure::default())
        });
        Ok(Self(learned.into_iter().collect::<Result<_, _>>()?))
    }

    /// Of each seed.
    fn all(&self) -> Result<Vec<(u64, EncoderMap<'_>)>, TrackingError> {
        let mut all = Vec::new();
        for (seed, image) in SEEDS.into_iter().zip(&self.0) {
            all.push((seed, EncoderMap::from_bytes(image)?));
        }
        Ok(all)
    }
}

/// `work` on all scenes with all encoders: of each scene the results of the encoders in order.
fn on_all<R: Send>(
    scenes: &[Scene],
    maps: &Maps,
    work: impl Fn(&Scene, u64, EncoderMap<'_>) -> Result<R, TrackingError> + Sync,
) -> Result<Vec<Vec<R>>, TrackingError> {
    let maps = maps.all()?;
    let jobs: Vec<_> = scenes
        .iter()
        .flat_map(|scene| maps.iter().map(move |map| (scene, map)))
        .collect();
    let done = parallel::map(&jobs, |(scene, (seed, map))| {
        work(scene, *seed, *map).map_err(|error| TrackingError::Scene {
            scene: scene.name,
            seed: *seed,
            error: Box::new(error),
        })
    });
    let mut done = done.into_iter();
    scenes
        .iter()
        .map(|_| done.by_ref().take(SEEDS.len()).collect())
        .collect()
}

/// Our axis there and back on a scene.
fn there_and_back(scene: &Scene, seed: u64, map: EncoderMap<'_>) -> Result<Trace, TrackingError> {
    let (params, _) = tuned_on(&scene.nominal)?;
    Rig::new(&params, &scene.machine(), seed, map)?.there_and_back(MOVE_MM, scene.feed_mm_per_min)
}

/// Setpoints of the move at the feed of a scene.
pub fn setpoints(scene: &Scene) -> Result<Vec<f64>, TrackingError> {
    let image = learn_simulated(&EncoderModel::real(), 1, &Procedure::default())?;
    let bare = Scene {
        feed_mm_per_min: scene.feed_mm_per_min,
        ..Scene::bare()
    };
    let trace = there_and_back(&bare, 1, EncoderMap::from_bytes(&image)?)?;
    Ok(trace.iter().map(|tick| tick.setpoint).collect())
}

/// Measures everything.
///
/// # Errors
/// Never with the scenes built in, which a test shows.
pub fn figures() -> Result<Figures, TrackingError> {
    let maps = Maps::learn()?;
    let moves = moves(&maps)?;
    let tunings = tunings()?;
    Ok(Figures {
        peer_gains: tunings.iter().map(gains).collect(),
        peer: peer(&maps, &moves, &tunings)?,
        backlash: backlash(&maps)?,
        creep: creep(&maps)?,
        carriage: carriage()?,
        threads: threads()?,
        moves,
    })
}

fn worst_moves(scenes: &[Scene], maps: &Maps) -> Result<Vec<MoveFigures>, TrackingError> {
    let done = on_all(scenes, maps, |scene, seed, map| {
        Ok(MoveFigures::of(&there_and_back(scene, seed, map)?))
    })?;
    Ok(done.iter().map(|all| MoveFigures::worst(all)).collect())
}

fn moves(maps: &Maps) -> Result<Vec<MoveRow>, TrackingError> {
    let scenes = Scene::of_moves();
    let figures = worst_moves(&scenes, maps)?;
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

fn backlash(maps: &Maps) -> Result<Vec<MoveRow>, TrackingError> {
    let scenes = Scene::with_backlash();
    let figures = worst_moves(&scenes, maps)?;
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

fn gains(tuning: &Tuning) -> PeerGains {
    let nominal = Scene::of_moves()[1].nominal;
    let margins = Margins::of(&tuning.params, &nominal.drive);
    PeerGains::new(tuning.name, &tuning.params, &margins)
}

/// The peer on the scenes of the moves, and how ours compare.
fn peer(maps: &Maps, moves: &[MoveRow], tunings: &[Tuning]) -> Result<Vec<PeerRow>, TrackingError> {
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
        let done = on_all(&scenes, maps, |scene, seed, _| {
            follow(&tuning.params, scene, seed)
        })?;
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

fn creep(maps: &Maps) -> Result<Vec<CreepRow>, TrackingError> {
    let scenes = [Scene::of_moves()[1], Scene::bare()];
    let mut rows = Vec::new();
    for feed in CREEP_MM_PER_MIN {
        let done = on_all(&scenes, maps, |scene, seed, map| {
            let (params, _) = tuned_on(&scene.nominal)?;
            let way = CREEP_MM.copysign(feed);
            let trace = Rig::new(&params, &scene.machine(), seed, map)?.feed(way, feed.abs())?;
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
        let errors = super::trace::errors(trace);
        let begin = trace
            .windows(2)
            .position(|pair| pair[0].setpoint != pair[1].setpoint)
            .unwrap_or_default();
        let (start, creep) = errors[begin..].split_at(CREEP_START.min(errors.len() - begin));
        let of = |errors: &[f64]| {
            errors
                .iter()
                .copied()
                .collect::<crate::statistics::Spread>()
        };
        Self {
            start_peak: of(start).peak(),
            peak: of(creep).peak(),
            rms: of(creep).rms(),
        }
    }
}
