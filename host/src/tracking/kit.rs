//! What every table starts from: the encoders' learned maps, and the axes commissioned from cold on each machine.

use leadscrew::encoder_map::EncoderMap;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::MachineParams;

use super::error::TrackingError;
use super::scene::Scene;
use super::tuned::{Cold, tuned_from_cold};
use crate::calibration::{Procedure, learn_simulated};
use crate::commissioning::has_disc;
use crate::parallel;

/// Encoders that a figure is the worst of.
pub const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];

/// A machine with an encoder, and the axis that was commissioned on it from cold.
struct Commissioned {
    machine: MachineParams,
    seed: u64,
    cold: Cold,
}

/// Learned maps in the order of the seeds, and axes.
pub struct Kit {
    maps: Vec<Vec<u8>>,
    commissioned: Vec<Commissioned>,
}

impl Kit {
    /// Learns the encoders, and commissions an axis on each of the machines that `scenes` tune on, with each encoder.
    pub fn new(scenes: &[Scene]) -> Result<Self, TrackingError> {
        let learned = parallel::map(&SEEDS, |seed| {
            learn_simulated(&EncoderModel::real(), *seed, &Procedure::default())
        });
        let mut jobs: Vec<(&Scene, u64)> = Vec::new();
        for scene in scenes {
            if jobs.iter().all(|(other, _)| other.nominal != scene.nominal) {
                jobs.extend(SEEDS.map(|seed| (scene, seed)));
            }
        }
        let mut kit = Self {
            maps: learned.into_iter().collect::<Result<_, _>>()?,
            commissioned: Vec::new(),
        };
        let commissioned = parallel::map(&jobs, |(scene, seed)| {
            let map = kit.map(&scene.nominal, *seed)?;
            let done = tuned_from_cold(&scene.nominal, map, *seed);
            Ok(Commissioned {
                machine: scene.nominal,
                seed: *seed,
                cold: done.map_err(|error| on_scene(scene, *seed, error))?,
            })
        });
        kit.commissioned = commissioned
            .into_iter()
            .collect::<Result<_, TrackingError>>()?;
        Ok(kit)
    }

    /// What was commissioned on `machine` with the encoder `seed`.
    ///
    /// # Errors
    /// [`TrackingError::NotCommissioned`] for one that the kit was not made for.
    pub fn cold(&self, machine: &MachineParams, seed: u64) -> Result<&Cold, TrackingError> {
        let same = |one: &&Commissioned| one.seed == seed && one.machine == *machine;
        let found = self.commissioned.iter().find(same);
        found
            .map(|one| &one.cold)
            .ok_or(TrackingError::NotCommissioned)
    }

    /// The learned map of an encoder of `machine`, which is one of those that were learned; none of a scale.
    pub fn map(
        &self,
        machine: &MachineParams,
        seed: u64,
    ) -> Result<Option<EncoderMap<'_>>, TrackingError> {
        let image = SEEDS.iter().position(|one| *one == seed);
        let image = image.and_then(|at| self.maps.get(at));
        match image {
            Some(image) if has_disc(machine) => Ok(Some(EncoderMap::from_bytes(image)?)),
            _ => Ok(None),
        }
    }
}

fn on_scene(scene: &Scene, seed: u64, error: TrackingError) -> TrackingError {
    TrackingError::Scene {
        scene: scene.name,
        seed,
        error: Box::new(error),
    }
}

/// `work` on all scenes with all encoders: of each scene the results of the encoders in order.
pub fn on_all<R: Send>(
    scenes: &[Scene],
    work: impl Fn(&Scene, u64) -> Result<R, TrackingError> + Sync,
) -> Result<Vec<Vec<R>>, TrackingError> {
    let jobs: Vec<_> = scenes
        .iter()
        .flat_map(|scene| SEEDS.map(|seed| (scene, seed)))
        .collect();
    let done = parallel::map(&jobs, |(scene, seed)| {
        work(scene, *seed).map_err(|error| on_scene(scene, *seed, error))
    });
    let mut done = done.into_iter();
    scenes
        .iter()
        .map(|_| done.by_ref().take(SEEDS.len()).collect())
        .collect()
}
