//! The figures of ISO 230-2 (2014 names), of deviations reduced to 20 °C. i is a target, ↑ and ↓ the direction; s has n − 1.
//!
//! ```text
//! x̄i↑ = Σ xij↑/n      si↑ = √(Σ (xij↑ − x̄i↑)²/(n − 1))     x̄i = (x̄i↑ + x̄i↓)/2     Bi = x̄i↑ − x̄i↓
//! B = max|Bi|   B̄ = ΣBi/m   Ri↑ = 4·si↑   Ri = max(2·si↑ + 2·si↓ + |Bi|, Ri↑, Ri↓)   R = max Ri
//! E↑ = max x̄i↑ − min x̄i↑   E = max(x̄i↑, x̄i↓) − min(x̄i↑, x̄i↓)   M = max x̄i − min x̄i
//! A↑ = max(x̄i↑ + 2·si↑) − min(x̄i↑ − 2·si↑)   A: the same over both directions
//! ```

use std::fmt;

use serde::Serialize;

use super::reduction::Expansion;
use super::runs::{Direction, Reading, Runs};

/// Fewest runs in each direction.
pub const FEWEST_RUNS: usize = 5;
/// Fewest targets a metre, and at all.
pub const FEWEST_TARGETS: usize = 5;

/// At a target, µm; pairs are ↑, ↓.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TargetFigures {
    /// The target, mm.
    pub target_mm: f64,
    /// Runs in each direction.
    pub runs: [usize; 2],
    /// Mean deviations x̄↑, x̄↓.
    pub mean_um: [f64; 2],
    /// Estimates of the standard deviation s↑, s↓.
    pub s_um: [f64; 2],
    /// Mean of both directions x̄.
    pub mean_of_both_um: f64,
    /// Reversal B.
    pub reversal_um: f64,
    /// Repeatability one way, 4·s.
    pub repeatability_one_way_um: [f64; 2],
    /// Repeatability of both directions R.
    pub repeatability_um: f64,
}

/// Of the axis, µm; pairs are ↑, ↓.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AxisFigures {
    /// Reversal B.
    pub reversal_um: f64,
    /// Mean reversal B̄.
    pub mean_reversal_um: f64,
    /// Repeatability one way R↑, R↓.
    pub repeatability_one_way_um: [f64; 2],
    /// Repeatability R.
    pub repeatability_um: f64,
    /// Systematic positioning error one way E↑, E↓.
    pub systematic_one_way_um: [f64; 2],
    /// Systematic positioning error E.
    pub systematic_um: f64,
    /// Range of the mean of both directions M.
    pub mean_range_um: f64,
    /// Accuracy one way A↑, A↓.
    pub accuracy_one_way_um: [f64; 2],
    /// Accuracy A.
    pub accuracy_um: f64,
}

/// All of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Calibration {
    /// Target by target, growing.
    pub targets: Vec<TargetFigures>,
    /// Of the axis.
    pub axis: AxisFigures,
    /// Fewest runs in a direction at a target, n.
    pub runs: usize,
    /// From the first target to the last, mm.
    pub length_mm: f64,
}

/// Why readings are no test after the standard.
#[derive(Clone, Debug, PartialEq)]
pub enum Unfit {
    /// Too few runs.
    Runs {
        /// Where, mm.
        target_mm: f64,
        /// Which way.
        direction: Direction,
        /// How many there are.
        runs: usize,
        /// How many there should be.
        needed: usize,
    },
    /// Too few targets.
    Targets {
        /// How many there are.
        targets: usize,
        /// How many there should be.
        needed: usize,
        /// From the first to the last, mm.
        length_mm: f64,
    },
}

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Runs {
                target_mm,
                direction,
                runs,
                needed,
            } => write!(
                f,
                "target {target_mm} mm has {runs} runs {}, {needed} are needed: measure more",
                direction.name()
            ),
            Self::Targets {
                targets,
                needed,
                length_mm,
            } => write!(
                f,
                "{targets} targets over {length_mm} mm, {needed} are needed: 5 at least, and 5 a metre"
            ),
        }
    }
}

impl std::error::Error for Unfit {}

impl Calibration {
    /// The figures of `runs`. With `is_strict` the standard's least numbers of runs and targets are asked for, else two of each.
    ///
    /// # Errors
    /// [`Unfit`].
    pub fn of(runs: &Runs, expansion: &Expansion, is_strict: bool) -> Result<Self, Unfit> {
        let (fewest_runs, fewest_targets) = if is_strict {
            (FEWEST_RUNS, FEWEST_TARGETS)
        } else {
            (2, 2)
        };
        let mut places: Vec<f64> = runs
            .readings
            .iter()
            .map(|reading| reading.target_mm)
            .collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        let length_mm = places
            .last()
            .zip(places.first())
            .map_or(0.0, |(last, first)| last - first);
        let per_metre = (length_mm / 1000.0 * FEWEST_TARGETS as f64).ceil() as usize;
        let needed = if is_strict {
            fewest_targets.max(per_metre)
        } else {
            fewest_targets
        };
        if places.len() < needed {
            return Err(Unfit::Targets {
                targets: places.len(),
                needed,
                length_mm,
            });
        }
        let targets = places
            .into_iter()
            .map(|place| TargetFigures::of(runs, expansion, place, fewest_runs))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self {
            axis: AxisFigures::of(&targets),
            runs: targets
                .iter()
                .flat_map(|target| target.runs)
                .min()
                .unwrap_or(0),
            targets,
            length_mm,
        })
    }
}

impl TargetFigures {
    fn of(
        runs: &Runs,
        expansion: &Expansion,
        target_mm: f64,
        fewest: usize,
    ) -> Result<Self, Unfit> {
        let at = |direction: Direction| -> Vec<f64> {
            let is_here = |reading: &&Reading| {
                reading.target_mm == target_mm && reading.direction == direction
            };
            let here = runs.readings.iter().filter(is_here);
            here.map(|reading| expansion.reduced(reading)).collect()
        };
        let deviations = Direction::BOTH.map(at);
        for (direction, deviations) in Direction::BOTH.into_iter().zip(&deviations) {
            if deviations.len() < fewest {
                return Err(Unfit::Runs {
                    target_mm,
                    direction,
                    runs: deviations.len(),
                    needed: fewest,
                });
            }
        }
        let mean_um = [0, 1].map(|way: usize| mean(&deviations[way]));
        let s_um = [0, 1].map(|way: usize| standard_deviation(&deviations[way]));
        let reversal_um = mean_um[0] - mean_um[1];
        let one_way = s_um.map(|s| 4.0 * s);
        let both_ways = 2.0 * s_um[0] + 2.0 * s_um[1] + reversal_um.abs();
        Ok(Self {
            target_mm,
            runs: [deviations[0].len(), deviations[1].len()],
            mean_um,
            s_um,
            mean_of_both_um: f64::midpoint(mean_um[0], mean_um[1]),
            reversal_um,
            repeatability_one_way_um: one_way,
            repeatability_um: both_ways.max(one_way[0]).max(one_way[1]),
        })
    }

    /// x̄ + 2·s (`sign` 1) or x̄ − 2·s (−1) of a direction.
    #[must_use]
    pub fn limit_um(&self, way: usize, sign: f64) -> f64 {
        self.mean_um[way] + sign * 2.0 * self.s_um[way]
    }
}

impl AxisFigures {
    fn of(targets: &[TargetFigures]) -> Self {
        let largest = |of: &dyn Fn(&TargetFigures) -> f64| {
            targets.iter().map(of).fold(f64::NEG_INFINITY, f64::max)
        };
        let smallest = |of: &dyn Fn(&TargetFigures) -> f64| {
            targets.iter().map(of).fold(f64::INFINITY, f64::min)
        };
        let highest = [0, 1].map(|way: usize| largest(&|target| target.mean_um[way]));
        let lowest = [0, 1].map(|way: usize| smallest(&|target| target.mean_um[way]));
        let top = [0, 1].map(|way: usize| largest(&|target| target.limit_um(way, 1.0)));
        let bottom = [0, 1].map(|way: usize| smallest(&|target| target.limit_um(way, -1.0)));
        let reversals = targets.iter().map(|target| target.reversal_um);
        Self {
            reversal_um: largest(&|target| target.reversal_um.abs()),
            mean_reversal_um: reversals.sum::<f64>() / targets.len() as f64,
            repeatability_one_way_um: [0, 1]
                .map(|way: usize| largest(&|target| target.repeatability_one_way_um[way])),
            repeatability_um: largest(&|target| target.repeatability_um),
            systematic_one_way_um: [0, 1].map(|way: usize| highest[way] - lowest[way]),
            systematic_um: highest[0].max(highest[1]) - lowest[0].min(lowest[1]),
            mean_range_um: largest(&|target| target.mean_of_both_um)
                - smallest(&|target| target.mean_of_both_um),
            accuracy_one_way_um: [0, 1].map(|way: usize| top[way] - bottom[way]),
            accuracy_um: top[0].max(top[1]) - bottom[0].min(bottom[1]),
        }
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn standard_deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    let squares: f64 = values
        .iter()
        .map(|value| (value - mean) * (value - mean))
        .sum();
    (squares / (values.len() as f64 - 1.0)).sqrt()
}
