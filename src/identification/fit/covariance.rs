//! How sure a solution is.
//!
//! The covariance is the larger of two that do not take errors as white, since those of an encoder and of a drive are
//! not: the sandwich H⁻¹·(Σ s·sᵀ)·H⁻¹ over the scores s of clusters of a period and a half, and the jackknife over the
//! chunks, which is how far the solution would move without each of them. To it comes what long waves of the encoder
//! could do, over which every chunk passes alike.

use super::sums::Clusters;
use super::waves::Waves;
use super::{Fit, Problem, part_free};
use crate::identification::drive::{PARAMETERS, Vector, place};
use crate::identification::matrix::{Matrix, part};

impl Problem<'_> {
    /// Covariance and figures of the solution.
    pub(super) fn finish(&self, vector: Vector, cost: f64) -> Option<Fit> {
        let (normal, _) = self.normal(&vector, cost);
        let inverse = normal.inverse()?;
        let free = self.free.iter().filter(|free| **free).count() as f64;
        let mut wide = Matrix::ZERO;
        let mut narrow = Clusters::default();
        let (mut records, mut chunks) = (0.0_f64, 0.0_f64);
        let mut peak = 0.0_f64;
        let length = self.narrow_cluster(&vector);
        let mut waves = Waves::new(self.records);
        let (mut drives, mut ahead) = (self.drives(&vector), self.drives(&vector));
        for chunk in self.chunks() {
            let sums = self.sums(&vector, chunk, &mut ahead);
            records += sums.count;
            chunks += 1.0;
            // What the solution would move by without this chunk.
            let (products, weighted) = sums.centred();
            let mut without = normal;
            without.add(&products, -1.0);
            let moved = without.inverse().unwrap_or(inverse).apply(&weighted);
            wide.add_product(&moved, &moved, 1.0);
            let means = sums.slopes.map(|sum| sum / sums.count.max(1.0));
            let mean_error = sums.error / sums.count.max(1.0);
            let mut index = 0_usize;
            self.run(chunk, &mut drives, |error, drives| {
                let mut slopes = self.slopes(&vector, drives);
                for (slope, mean) in slopes.iter_mut().zip(&means) {
                    *slope -= mean;
                }
                waves.add(&slopes);
                narrow.add(&slopes.map(|slope| slope * (error - mean_error)));
                index = index.wrapping_add(1);
                if index.is_multiple_of(length) {
                    narrow.end();
                }
                if let Some(drive) = drives.first() {
                    peak = peak.max(libm::fabs(drive.acceleration()));
                }
            });
            narrow.end();
        }
        let freedom = narrow.count / (narrow.count - free).max(2.0);
        let narrow = inverse.times(&narrow.products).times(&inverse);
        let jackknife = (chunks - 1.0) / chunks.max(1.0);
        let variance = cost / records.max(1.0);
        let mut covariance = waves.covariance(&inverse, variance);
        for i in 0..PARAMETERS {
            for j in 0..PARAMETERS {
                let scale = |k: usize| {
                    let (wide, narrow) = (wide.at(k, k) * jackknife, narrow.at(k, k));
                    libm::sqrt((narrow * freedom).max(wide) / narrow.max(1e-300))
                };
                let of_both = narrow.at(i, j) * scale(i) * scale(j);
                covariance.set(i, j, covariance.at(i, j) + of_both);
                if !(part_free(&self.free, i) && part_free(&self.free, j)) {
                    covariance.set(i, j, 0.0);
                }
            }
        }
        Some(Fit {
            vector,
            covariance,
            cost,
            rms_d: libm::sqrt(cost / f64::max(records, 1.0)),
            peak_acceleration: peak,
        })
    }

    /// Records of a narrow cluster: errors further apart than a period and a half have little in common.
    fn narrow_cluster(&self, vector: &Vector) -> usize {
        let period = core::f64::consts::TAU / libm::exp(part(vector, place::LN_OMEGA));
        (1.5 * period).clamp(16.0, 1000.0) as usize
    }
}
