//! Several runs made into one mean, and compared.

use super::bands::{Harmonics, bands, segment_means};
use super::compare::{Record, compare, noise};
use super::learned::{Directional, Learned};
use super::pattern::{self, Match};
use super::refusal::Refusal;
use super::report::{MAX_RUNS, Report, Requirements, RunSummary, SPEED_RATIO};
use super::run::Run;
use super::segments::{SEGMENTS, within_revolution};

/// Units of the mean in a d.
pub const MEAN_PER_D: f64 = 4096.0;
/// Units of the sums of a run in a d.
const SUM_PER_D: f64 = 65_536.0;
/// Counts by which the front of the index may differ from run to run.
const FRONT_PLAY: u32 = 1;

/// Sums over the runs of one direction, weighted by revolutions.
#[derive(Clone, Copy, Debug, Default)]
struct DirectionSums {
    phases: [f64; 4],
    front: f64,
    revolutions: f64,
}

impl DirectionSums {
    fn add(&mut self, phases: [f64; 4], front: i32, revolutions: f64) {
        for (sum, phase) in self.phases.iter_mut().zip(phases) {
            *sum += phase * revolutions;
        }
        self.front += f64::from(front) * revolutions;
        self.revolutions += revolutions;
    }

    fn mean(&self) -> Option<Directional> {
        (self.revolutions > 0.0).then(|| Directional {
            phases_d: self.phases.map(|sum| sum / self.revolutions),
            front: libm::round(self.front / self.revolutions) as i32,
        })
    }
}

/// The runs so far.
#[derive(Debug)]
pub struct Combination {
    edges: u32,
    records: [Record; MAX_RUNS],
    summaries: [RunSummary; MAX_RUNS],
    count: usize,
    /// Revolutions of all runs.
    revolutions: f64,
    /// Forward, backward.
    directions: [DirectionSums; 2],
}

impl Combination {
    pub fn new(edges: u32) -> Self {
        Self {
            edges,
            records: [Record::NONE; MAX_RUNS],
            summaries: [RunSummary::default(); MAX_RUNS],
            count: 0,
            revolutions: 0.0,
            directions: [DirectionSums::default(); 2],
        }
    }

    /// Refuses a run too many.
    pub const fn check_room(&self) -> Result<(), Refusal> {
        if self.count < MAX_RUNS {
            Ok(())
        } else {
            Err(Refusal::TooManyRuns { limit: MAX_RUNS })
        }
    }

    /// Adds a run whose average is in `sums` to the mean.
    pub fn add(
        &mut self,
        run: &Run,
        sums: &mut [i32],
        mean: &mut [i16],
    ) -> Result<RunSummary, Refusal> {
        self.check_room()?;
        let (average, fronts) = run.complete()?;
        scale(sums, 1.0 / average.magnification());
        let phases = take_phases(sums);
        let sigma = average.pass_sigma_d();
        let edge_variance = sigma * sigma * average.noise_gain();
        let shift = self.align(sums, mean, edge_variance)?;
        let front = fronts.front().wrapping_sub(shift);
        self.check_front(front, shift, run.is_backward())?;
        check_size(sums)?;

        let errors = || sums.iter().map(|&sum| f64::from(sum) / SUM_PER_D);
        let earlier = || mean.iter().map(|&error| f64::from(error) / MEAN_PER_D);
        let less_earlier = || errors().zip(earlier()).map(|(run, mean)| run - mean);
        let mut halves = [0.0; SEGMENTS];
        for (segment, half) in halves.iter_mut().enumerate() {
            *half = average.halves_difference_d(segment);
        }
        let summary = RunSummary {
            backward: run.is_backward(),
            revolutions: average.revolutions(),
            speed_d_s: average.velocity() * run.timer_hz(),
            pass_sigma_d: sigma,
            errors: bands(self.edges, errors),
            less_earlier_runs: (self.count > 0).then(|| bands(self.edges, less_earlier)),
            halves: Harmonics::of(self.edges, halves).bands(),
        };
        self.store(
            summary,
            Record::new(segment_means(self.edges, errors()), edge_variance),
        );
        let revolutions = f64::from(summary.revolutions);
        if let Some(direction) = self.directions.get_mut(usize::from(summary.backward)) {
            direction.add(phases, front, revolutions);
        }
        self.revolutions += revolutions;
        blend(sums, mean, revolutions / self.revolutions);
        Ok(summary)
    }

    fn store(&mut self, summary: RunSummary, record: Record) {
        let (summaries, records) = (
            self.summaries.get_mut(self.count),
            self.records.get_mut(self.count),
        );
        if let (Some(kept_summary), Some(kept_record)) = (summaries, records) {
            *kept_summary = summary;
            *kept_record = record;
            self.count = self.count.wrapping_add(1);
        }
    }

    /// Turns the run so that its edges are those of the mean; gives the counts by which it was turned.
    fn align(&self, sums: &mut [i32], mean: &[i16], edge_variance: f64) -> Result<i32, Refusal> {
        if self.count == 0 {
            return Ok(0);
        }
        let run = self.count;
        let known = self.records.iter().take(run).map(Record::edge_variance);
        let noise = known.fold(edge_variance, f64::max);
        match pattern::compare(sums, mean, noise) {
            Match::Featureless => Ok(0),
            Match::Different => Err(Refusal::PatternDiffers { run }),
            Match::At(shift) if shift % 4 != 0 => {
                Err(Refusal::PatternShifted { run, off_by: shift })
            }
            Match::At(shift) => {
                sums.rotate_left(within_revolution(i64::from(shift), self.edges) as usize);
                Ok(shift)
            }
        }
    }

    /// In one direction the front must be where it was.
    fn check_front(&self, front: i32, shift: i32, backward: bool) -> Result<(), Refusal> {
        let known = self
            .directions
            .get(usize::from(backward))
            .and_then(DirectionSums::mean);
        match known {
            Some(known) if front.abs_diff(known.front) > FRONT_PLAY => {
                Err(Refusal::PatternShifted {
                    run: self.count,
                    off_by: shift,
                })
            }
            _ => Ok(()),
        }
    }

    /// Runs so far.
    pub const fn runs(&self) -> usize {
        self.count
    }

    /// The map that the runs give.
    pub fn finish<'w>(
        &self,
        mean: &'w mut [i16],
        requirements: &Requirements,
    ) -> Result<Learned<'w>, Refusal> {
        if self.count == 0 {
            return Err(Refusal::NoRun);
        }
        let mut report = Report::new(self.summaries, self.count);
        let (slowest, fastest) = report.speeds();
        report.one_speed = fastest < slowest * SPEED_RATIO;
        report.errors = bands(self.edges, || {
            mean.iter().map(|&error| f64::from(error) / MEAN_PER_D)
        });
        report.noise = (!report.one_speed).then(|| noise(report.runs()));
        let mut directions = self.directions.map(|sums| sums.mean());
        if let [Some(forward), Some(backward)] = directions {
            report.hysteresis_a_less_b_d = Some(hysteresis(&forward, &backward));
        }
        let records = self.records.get(..self.count).unwrap_or(&[]);
        (report.disagreement, report.residual) = compare(self.edges, report.runs(), records);
        report.check(requirements)?;
        turn_to_forward_front(mean, &mut directions);
        Ok(Learned {
            errors: mean,
            directions,
            report,
        })
    }
}

/// Multiplies the sums by a factor near one.
fn scale(sums: &mut [i32], factor: f64) {
    for sum in sums {
        *sum = libm::round(f64::from(*sum) * factor) as i32;
    }
}

/// Takes the mean of each phase out of the sums and gives it less the mean of all, d.
fn take_phases(sums: &mut [i32]) -> [f64; 4] {
    let lines = (sums.len() / 4).max(1) as f64;
    let mut totals = [0_i64; 4];
    for line in sums.chunks_exact(4) {
        for (total, &sum) in totals.iter_mut().zip(line) {
            *total = total.wrapping_add(i64::from(sum));
        }
    }
    let means = totals.map(|total| total as f64 / lines);
    for line in sums.chunks_exact_mut(4) {
        for (sum, mean) in line.iter_mut().zip(means) {
            *sum = sum.wrapping_sub(libm::round(mean) as i32);
        }
    }
    let mean = means.iter().sum::<f64>() / 4.0;
    means.map(|phase| (phase - mean) / SUM_PER_D)
}

/// Refuses errors that the mean cannot hold.
fn check_size(sums: &[i32]) -> Result<(), Refusal> {
    let largest = sums.iter().map(|sum| sum.unsigned_abs()).max().unwrap_or(0);
    let error_d = f64::from(largest) / SUM_PER_D;
    let limit_d = f64::from(i16::MAX) / MEAN_PER_D;
    if error_d >= limit_d {
        return Err(Refusal::ErrorTooLarge { error_d, limit_d });
    }
    Ok(())
}

/// Moves the mean to the run by the run's share. The first run's share is all.
fn blend(sums: &[i32], mean: &mut [i16], share: f64) {
    for (mean, &sum) in mean.iter_mut().zip(sums) {
        let run = f64::from(sum) * (MEAN_PER_D / SUM_PER_D);
        let old = if share < 1.0 { f64::from(*mean) } else { 0.0 };
        *mean = libm::round(old + share * (run - old)) as i16;
    }
}

/// Hysteresis of A (odd edges) less that of B: a backward edge lies lower by it.
fn hysteresis(forward: &Directional, backward: &Directional) -> f64 {
    let differences = forward
        .phases_d
        .iter()
        .zip(backward.phases_d)
        .map(|(forward, backward)| forward - backward);
    let signs = [-0.5, 0.5, -0.5, 0.5];
    differences
        .zip(signs)
        .map(|(difference, sign)| difference * sign)
        .sum()
}

/// Makes boundary 0 the first multiple of 4 at or after the forward front.
fn turn_to_forward_front(mean: &mut [i16], directions: &mut [Option<Directional>; 2]) {
    let Some(forward) = directions.first().copied().flatten() else {
        return;
    };
    let zero = forward.front.wrapping_add(3) & !3;
    let turn = within_revolution(i64::from(zero), mean.len() as u32);
    mean.rotate_left(turn as usize);
    for direction in directions.iter_mut().flatten() {
        direction.front = direction.front.wrapping_sub(zero);
    }
}
