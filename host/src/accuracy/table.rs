//! The figures: all rows, all columns, with what helps and without.

use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::EstimatorConfig;
use leadscrew_hal_mock::scene::Ripple;

use super::SEEDS;
use super::bound::bound;
use super::columns::COLUMNS;
use super::error::AccuracyError;
use super::figures::{Figures, RowFigures, Stated, VariantFigures};
use super::in_loop::in_loop;
use super::maps::{self, Known};
use super::methods::{estimators, fit_of};
use super::rows::{ROWS, Row};
use super::run::{RunFigures, RunSpec};
use super::variant::Variant;
use crate::parallel;

/// A run to be done.
#[derive(Clone, Copy)]
struct Job {
    variant: Variant,
    row: Row,
    /// Place of the encoder among the seeds.
    encoder: usize,
    backward: bool,
}

/// Learns the encoders and measures everything.
///
/// # Errors
/// Never with the scenes built in, which a test shows.
pub fn figures() -> Result<Figures, AccuracyError> {
    let ripples = [Ripple::NONE, Ripple::TWICE_A_REVOLUTION];
    let to_learn: Vec<_> = ripples
        .into_iter()
        .flat_map(|ripple| SEEDS.map(|seed| (seed, ripple)))
        .collect();
    let known = parallel::map(&to_learn, |(seed, ripple)| maps::learn(*seed, *ripple));
    let known = known.into_iter().collect::<Result<Vec<_>, _>>()?;
    let estimators = estimators()?;
    let jobs = jobs();
    let done = parallel::map(&jobs, |job| job.run(&known, &estimators));
    let done = done.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut variants = Vec::new();
    let mut stated = Vec::new();
    let runs_of_row = 2 * SEEDS.len();
    let of_rows: Vec<_> = done.chunks(runs_of_row).collect();
    for (variant, of_rows) in Variant::ALL.into_iter().zip(of_rows.chunks(ROWS.len())) {
        let rows = ROWS
            .iter()
            .zip(of_rows)
            .map(|(row, runs)| RowFigures::new(variant, row, runs));
        variants.push(VariantFigures {
            variant,
            rows: rows.collect(),
        });
        if variant == Variant::Learned {
            let of_row = |(row, runs): (&Row, &&[RunFigures])| Stated::of(row, runs);
            stated.extend(ROWS.iter().zip(of_rows).flat_map(of_row));
        }
    }
    Ok(Figures {
        variants,
        stated,
        bound: bound()?,
        in_loop: in_loop(&known[..SEEDS.len()])?,
    })
}

/// All runs: those of a row together, rows in order, variant after variant.
fn jobs() -> Vec<Job> {
    let mut jobs = Vec::new();
    for variant in Variant::ALL {
        for row in ROWS {
            for encoder in 0..SEEDS.len() {
                for backward in [false, true] {
                    jobs.push(Job {
                        variant,
                        row,
                        encoder,
                        backward,
                    });
                }
            }
        }
    }
    jobs
}

impl Job {
    fn run(
        &self,
        known: &[Known],
        estimators: &[EstimatorConfig],
    ) -> Result<RunFigures, AccuracyError> {
        let rippling = self.variant == Variant::ShaftSynchronous;
        let known = &known[self.encoder + if rippling { SEEDS.len() } else { 0 }];
        let map = match self.variant {
            Variant::WithoutMap => None,
            _ => Some(EncoderMap::from_bytes(&known.image)?),
        };
        let spec = RunSpec {
            row: if self.backward {
                self.row.reversed()
            } else {
                self.row
            },
            model: self.variant.model(),
            seed: SEEDS[self.encoder],
            map,
            residue: (self.variant == Variant::Learned).then_some(&known.residue),
            ripple: self.variant.ripple(),
            every_edge: self.variant != Variant::OneStamp,
        };
        let columns = COLUMNS.map(|column| (fit_of(&column), column));
        spec.run(estimators, &columns)
    }
}
