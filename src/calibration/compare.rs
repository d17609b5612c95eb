//! What the differences between runs say about their mean.

use super::bands::{Bands, Harmonics, ORDERS, Segments};
use super::combine::MEAN_PER_D;
use super::report::{Disagreement, Noise, Residual, RunSummary};
use super::segments::SEGMENTS;

/// What is kept of a run to compare it.
#[derive(Clone, Copy, Debug)]
pub struct Record {
    /// Means of the segments, 1/4096 d.
    segments: [i16; SEGMENTS],
    edge_variance: f64,
}

impl Record {
    /// No run.
    pub const NONE: Self = Self {
        segments: [0; SEGMENTS],
        edge_variance: 0.0,
    };

    /// A run whose average has these means of its segments, d, and a white error of each edge, d².
    pub fn new(segments: Segments, edge_variance: f64) -> Self {
        Self {
            segments: segments.map(|error| libm::round(error * MEAN_PER_D) as i16),
            edge_variance,
        }
    }

    /// White error of an edge of the average, d².
    pub const fn edge_variance(&self) -> f64 {
        self.edge_variance
    }

    fn segments_d(&self) -> Segments {
        self.segments.map(|mean| f64::from(mean) / MEAN_PER_D)
    }
}

/// Compares runs of an encoder of `edges` with their mean, in which each has the share of its revolutions.
pub fn compare(
    edges: u32,
    summaries: &[RunSummary],
    records: &[Record],
) -> (Disagreement, Residual) {
    let revolutions: f64 = summaries.iter().map(|run| f64::from(run.revolutions)).sum();
    let shares = || {
        summaries
            .iter()
            .map(|run| f64::from(run.revolutions) / revolutions)
    };
    let share_squares: f64 = shares().map(|share| share * share).sum();
    let mut mean = [0.0; SEGMENTS];
    let mut edge_variance = STEP_VARIANCE;
    for (share, record) in shares().zip(records) {
        edge_variance += share * share * record.edge_variance;
        for (mean, segment) in mean.iter_mut().zip(record.segments_d()) {
            *mean += share * segment;
        }
    }
    let mut disagreement = Disagreement::default();
    let mut variances = [0.0; ORDERS];
    for (run, (share, record)) in shares().zip(records).enumerate() {
        let mut off = record.segments_d();
        for (off, mean) in off.iter_mut().zip(mean) {
            *off -= mean;
        }
        // Variance of the mean: Σ g²|c − c̄|²/(1 − Σ g²) for runs of the shares g.
        let gain = share * share / (1.0 - share_squares).max(f64::EPSILON);
        let harmonics = Harmonics::of(edges, off);
        for (variance, (order, amplitude)) in variances.iter_mut().zip(harmonics.amplitudes()) {
            *variance += gain * amplitude * amplitude / 2.0;
            if amplitude > disagreement.difference_d {
                disagreement = Disagreement {
                    order,
                    difference_d: amplitude,
                    run,
                };
            }
        }
    }
    let noise = Floor {
        // A harmonic has two of the N parts of white noise, or of those of the segments.
        variance: 2.0 * edge_variance / f64::from(edges)
            + 2.0 * STEP_VARIANCE * share_squares / SEGMENTS as f64,
        runs: summaries.len() as f64,
    };
    let mut standing = variances.map(|variance| noise.excess(variance));
    if let [only] = summaries {
        variances = of_halves(&only.halves);
        standing = variances;
    }
    (
        disagreement,
        residual(edges, &variances, &standing, edge_variance),
    )
}

/// Variance of the rounding to 1/[`MEAN_PER_D`] d.
const STEP_VARIANCE: f64 = 1.0 / (12.0 * MEAN_PER_D * MEAN_PER_D);

/// What white errors of the edges alone make the runs differ by in a harmonic.
struct Floor {
    /// Expected variance of the mean, d².
    variance: f64,
    runs: f64,
}

impl Floor {
    /// What of a harmonic's variance stands out of the noise.
    ///
    /// A slope and a curvature are stated of waves that a window cannot average. White errors it does average, and they
    /// are stated as such: taken for waves as well they would be counted a second time and, since curvature goes with the
    /// square of the order, as much more than they do. The estimate from n runs has 2(n − 1) degrees of freedom; of
    /// four runs three harmonics in a thousand exceed it by four standard deviations by chance.
    fn excess(&self, variance: f64) -> f64 {
        let deviation = libm::sqrt(1.0 / (self.runs - 1.0).max(1.0));
        if variance > self.variance * (1.0 + 4.0 * deviation) {
            variance - self.variance
        } else {
            0.0
        }
    }
}

/// Variances of the orders of a single run: the mean of two halves is off by half their difference. What a band
/// holds is laid into its highest order, where it does most harm.
fn of_halves(halves: &Bands) -> [f64; ORDERS] {
    let bands = [
        (1, halves.first),
        (2, halves.second),
        (10, halves.third_to_tenth),
        (ORDERS, halves.eleventh_to_32nd),
    ];
    let mut variances = [0.0; ORDERS];
    for (order, rms) in bands {
        if let Some(variance) = variances.get_mut(order.wrapping_sub(1)) {
            *variance = rms * rms / 4.0;
        }
    }
    variances
}

fn residual(
    edges: u32,
    variances: &[f64; ORDERS],
    standing: &[f64; ORDERS],
    edge_variance: f64,
) -> Residual {
    let weighted = |variances: &[f64; ORDERS], power: f64| {
        let of_order = |(order, &variance): (u32, &f64)| {
            let wave_number = core::f64::consts::TAU * f64::from(order) / f64::from(edges);
            variance * libm::pow(wave_number, power)
        };
        libm::sqrt((1..).zip(variances).map(of_order).sum())
    };
    Residual {
        edge_sigma_d: libm::sqrt(edge_variance),
        long_wave_d: weighted(variances, 0.0),
        slope: weighted(variances, 2.0),
        curvature_per_d: weighted(variances, 4.0),
        standing_slope: weighted(standing, 2.0),
        standing_curvature_per_d: weighted(standing, 4.0),
    }
}

/// Fits σ² = σ_d² + (σ_s·v)² to runs at two speeds or more.
pub fn noise(summaries: &[RunSummary]) -> Noise {
    let square = |value: f64| value * value;
    let points = || {
        summaries
            .iter()
            .map(|run| (square(run.speed_d_s), square(run.pass_sigma_d)))
    };
    let count = summaries.len() as f64;
    let (sum_x, sum_y) = points().fold((0.0, 0.0), |(x, y), (dx, dy)| (x + dx, y + dy));
    let (mean_x, mean_y) = (sum_x / count, sum_y / count);
    let (mut above, mut below) = (0.0, 0.0);
    for (x, y) in points() {
        above += (x - mean_x) * (y - mean_y);
        below += square(x - mean_x);
    }
    let slope = (above / below).min(mean_y / mean_x).max(0.0);
    Noise {
        place_d: libm::sqrt((mean_y - slope * mean_x).max(0.0)),
        time_s: libm::sqrt(slope),
    }
}
