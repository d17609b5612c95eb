//! Whether two runs show the same lines, and at which shift.

use super::segments::within_revolution;

/// Counts by which patterns are tried against each other, to both sides.
const REACH: i32 = 16;
/// Distance over which errors are differenced: the same phase of the next line. Long waves drop out.
const LINE: usize = 4;
/// A shift is clear if any other fits worse by this factor.
const CLEAR: f64 = 2.0;
/// The lines differ visibly if their variance is this many times that of the noise.
const VISIBLE: f64 = 9.0;
/// Variance of rounding the mean, d².
const ROUNDING: f64 = 1.0 / (4096.0 * 4096.0 * 12.0);

/// What comparing the lines of two runs shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Match {
    /// Edge k of the mean is edge k + shift of the run.
    At(i32),
    /// The lines are too regular to tell.
    Featureless,
    /// The lines are others.
    Different,
}

/// Compares the errors of a run (Q.16 d) with the mean of those before (1/4096 d), whose edges have white errors
/// of `noise_variance` d² each.
pub fn compare(run: &[i32], mean: &[i16], noise_variance: f64) -> Match {
    let visible = VISIBLE * 2.0 * (noise_variance + ROUNDING);
    let neighbours = mean.iter().zip(mean.iter().cycle().skip(LINE));
    let steps = neighbours.map(|(&here, &next)| i64::from(next).wrapping_sub(i64::from(here)));
    if mean_square(steps) < visible {
        return Match::Featureless;
    }
    let (mut best, mut second) = ((f64::INFINITY, 0), f64::INFINITY);
    for shift in REACH.wrapping_neg()..=REACH {
        let misfit = misfit(run, mean, shift);
        if misfit < best.0 {
            second = best.0;
            best = (misfit, shift);
        } else if misfit < second {
            second = misfit;
        }
    }
    if second >= CLEAR * best.0 {
        Match::At(best.1)
    } else {
        Match::Different
    }
}

/// Mean square difference of the steps from line to line at a shift, d².
fn misfit(run: &[i32], mean: &[i16], shift: i32) -> f64 {
    let from = within_revolution(i64::from(shift), mean.len() as u32) as usize;
    let run_at = |offset: usize| run.iter().cycle().skip(from.wrapping_add(offset));
    let mean_at = |offset: usize| mean.iter().cycle().skip(offset);
    let pairs = run_at(LINE)
        .zip(run_at(0))
        .zip(mean_at(LINE).zip(mean_at(0)));
    let steps = pairs
        .take(mean.len())
        .map(|((&next, &here), (&mean_next, &mean_here))| {
            let step = i64::from(next).wrapping_sub(i64::from(here)) >> 4;
            let mean_step = i64::from(mean_next).wrapping_sub(i64::from(mean_here));
            step.wrapping_sub(mean_step)
        });
    mean_square(steps)
}

/// Mean square of steps in 1/4096 d, d².
fn mean_square(steps: impl Iterator<Item = i64>) -> f64 {
    let (mut sum, mut count) = (0_i64, 0_u32);
    for step in steps {
        sum = sum.wrapping_add(step.wrapping_mul(step));
        count = count.wrapping_add(1);
    }
    sum as f64 / f64::from(count.max(1)) / (4096.0 * 4096.0)
}
