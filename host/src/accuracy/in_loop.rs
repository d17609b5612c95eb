//! The observer in the loop, over all encoders.

use leadscrew::encoder_map::EncoderMap;
use serde::Serialize;

use super::SEEDS;
use super::error::AccuracyError;
use super::maps::Known;
use crate::closed_loop::{LoopCase, LoopFigures};
use crate::parallel;

/// A move of a machine with the observer in the loop, the worst of all encoders.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LoopRow {
    /// The machine, or how its drive's gain and natural period differ from what observer and loop count on.
    pub machine: &'static str,
    /// Feed, mm/min.
    pub feed_mm_per_min: f64,
    /// Where the loop's poles are placed, rad/s.
    pub bandwidth_rad_per_s: f64,
    /// Rms error of the velocity at the sampling instant, d/tick.
    pub sigma_v: f64,
    /// Rms error of the acceleration at the sampling instant, d/tick².
    pub sigma_a: f64,
    /// What is to be reached by the latter.
    pub limit: Option<f64>,
    /// Largest following error at the encoder, d.
    pub following_peak: f64,
}

impl LoopRow {
    /// The limit is kept, if there is one.
    #[must_use]
    pub fn reached(&self) -> Option<bool> {
        self.limit.map(|limit| self.sigma_a <= limit)
    }

    fn worst(case: &LoopCase, runs: &[LoopFigures]) -> Self {
        let largest = |of: &dyn Fn(&LoopFigures) -> f64| runs.iter().map(of).fold(0.0, f64::max);
        Self {
            machine: case.name,
            feed_mm_per_min: case.feed_mm_per_min,
            bandwidth_rad_per_s: case.bandwidth_rad_per_s,
            sigma_v: largest(&|run| run.velocity.rms()),
            sigma_a: largest(&|run| run.acceleration.rms()),
            limit: case.limit,
            following_peak: largest(&|run| run.following.peak_of_some().unwrap_or(0.0)),
        }
    }
}

/// All cases with the encoders `known`, in the order of the seeds.
pub(super) fn in_loop(known: &[Known]) -> Result<Vec<LoopRow>, AccuracyError> {
    let cases = LoopCase::all();
    let jobs: Vec<_> = cases
        .iter()
        .flat_map(|case| SEEDS.into_iter().zip(known).map(move |job| (case, job)))
        .collect();
    let done = parallel::map(&jobs, |(case, (seed, known))| {
        let map = EncoderMap::from_bytes(&known.image)?;
        Ok(case.run(*seed, map)?)
    });
    let done = done
        .into_iter()
        .collect::<Result<Vec<_>, AccuracyError>>()?;
    let of_cases = cases.iter().zip(done.chunks(SEEDS.len()));
    Ok(of_cases
        .map(|(case, runs)| LoopRow::worst(case, runs))
        .collect())
}
