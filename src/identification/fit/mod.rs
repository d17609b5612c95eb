//! Least squares of a drive's motion under the recorded commands against the recorded motion.
//!
//! The output error is that of position, chunk by chunk, each from a rest to the next one: the place where a chunk
//! begins is free (the mean of its errors is taken out), so that what an encoder adds to a whole motion does not count. Gauss–Newton with Levenberg's damping;
//! derivatives come from drives that run beside the first one, each with one parameter moved.
//!
//! How sure the result is, `covariance` says.

mod bounds;
mod covariance;
mod sums;
mod waves;

use self::sums::Sums;
use super::drive::{Drive, PARAMETERS, Vector, place};
use super::matrix::{Matrix, part, set};
use super::recorder::Records;

/// Zero commands that end a chunk, records.
const REST: usize = 8;
/// Most iterations.
const ITERATIONS: usize = 40;

/// Which parameters are free.
pub type Free = [bool; PARAMETERS];

/// A least-squares problem.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'r> {
    /// What was measured.
    pub records: Records<'r>,
    /// Parameters that are looked for.
    pub free: Free,
    /// Static friction, as the aim that breaks away, forward and backward; none if nothing holds the axis.
    pub held: Option<[f64; 2]>,
    /// What ln of the Stribeck speed is thought to be, within a factor e; data seldom say much of it.
    pub ln_stribeck: f64,
}

/// What a fit came to.
#[derive(Clone, Copy, Debug)]
pub struct Fit {
    /// The parameters.
    pub vector: Vector,
    /// Their covariance; zero for those that were not free.
    pub covariance: Matrix,
    /// Sum of squares, d².
    pub cost: f64,
    /// Rms of the errors, d.
    pub rms_d: f64,
    /// Largest acceleration of the model, d a record².
    pub peak_acceleration: f64,
}

impl Problem<'_> {
    /// The best parameters from `start` on; none if the data do not determine them.
    #[must_use]
    pub fn solve(&self, start: &Vector) -> Option<Fit> {
        let mut vector = self.bounded(start);
        let mut damping = 1e-3;
        let mut cost = self.cost(&vector);
        for _ in 0..ITERATIONS {
            let (mut normal, mut gradient) = self.normal(&vector, cost);
            self.hold_at_bounds(&vector, &mut normal, &mut gradient);
            let before = cost;
            let mut improved = false;
            for _ in 0..8 {
                let mut damped = normal;
                for i in 0..PARAMETERS {
                    damped.set(i, i, normal.at(i, i) * (1.0 + damping));
                }
                let step = damped.inverse()?.apply(&gradient);
                let mut trial = vector;
                for (value, step) in trial.iter_mut().zip(&step) {
                    *value += step;
                }
                let trial = self.bounded(&trial);
                let trial_cost = self.cost(&trial);
                if trial_cost < cost {
                    (vector, cost) = (trial, trial_cost);
                    damping = (damping * 0.2).max(1e-9);
                    improved = true;
                    break;
                }
                damping *= 6.0;
            }
            if !improved || before - cost < 1e-7 * before {
                break;
            }
        }
        self.finish(vector, cost)
    }

    /// Sum of squared errors; the mean error of each chunk is free.
    #[must_use]
    pub fn cost(&self, vector: &Vector) -> f64 {
        let mut cost = 0.0;
        let mut drive = [self.drive(vector)];
        for chunk in self.chunks() {
            let (mut count, mut sum, mut square) = (0.0, 0.0, 0.0);
            self.run(chunk, &mut drive, |error, _| {
                count += 1.0;
                sum += error;
                square += error * error;
            });
            cost += square - sum * sum / f64::max(count, 1.0);
        }
        if cost.is_finite() { cost } else { f64::MAX }
    }

    /// Largest acceleration of a drive with that vector, d a record².
    #[must_use]
    pub fn peak_acceleration(&self, vector: &Vector) -> f64 {
        let mut peak = 0.0_f64;
        let mut drive = [self.drive(vector)];
        for chunk in self.chunks() {
            self.run(chunk, &mut drive, |_, drives| {
                for drive in drives {
                    peak = peak.max(libm::fabs(drive.acceleration()));
                }
            });
        }
        peak
    }

    /// Normal equations at a vector: H and the right-hand side.
    fn normal(&self, vector: &Vector, cost: f64) -> (Matrix, Vector) {
        let mut normal = Matrix::ZERO;
        let mut gradient = [0.0; PARAMETERS];
        let mut drives = self.drives(vector);
        for chunk in self.chunks() {
            let (products, weighted) = self.sums(vector, chunk, &mut drives).centred();
            normal.add(&products, 1.0);
            for (sum, part) in gradient.iter_mut().zip(&weighted) {
                *sum += part;
            }
        }
        let i = place::LN_STRIBECK;
        if part_free(&self.free, i) {
            let weight = self.prior_weight(cost);
            normal.set(i, i, normal.at(i, i) + weight);
            set(&mut gradient, i, |g| {
                g + weight * (self.ln_stribeck - part(vector, i))
            });
        }
        for i in 0..PARAMETERS {
            if !part_free(&self.free, i) {
                normal.set(i, i, 1.0);
            }
        }
        (normal, gradient)
    }

    /// The prior counts as one good look at the Stribeck speed.
    fn prior_weight(&self, cost: f64) -> f64 {
        cost / (self.records.len() as f64).max(1.0)
    }

    fn sums(&self, vector: &Vector, chunk: (usize, usize), drives: &mut [Drive]) -> Sums {
        let mut sums = Sums::ZERO;
        self.run(chunk, drives, |error, drives| {
            sums.add(error, &self.slopes(vector, drives));
        });
        sums
    }

    /// The drive of `vector`, and one for each parameter that is moved by its step.
    fn drives(&self, vector: &Vector) -> [Drive; PARAMETERS + 1] {
        let mut drives = [self.drive(vector); PARAMETERS + 1];
        for (i, drive) in drives.iter_mut().skip(1).enumerate() {
            if part_free(&self.free, i) {
                let mut moved = *vector;
                set(&mut moved, i, |value| value + step(vector, i));
                *drive = self.drive(&moved);
            }
        }
        drives
    }

    fn drive(&self, vector: &Vector) -> Drive {
        // Whatever ran before the records ended with a pulse backward.
        Drive::new(vector, self.held).last_driven(-1.0)
    }

    /// Slopes of the travel.
    fn slopes(&self, vector: &Vector, drives: &[Drive]) -> Vector {
        let travel = drives.first().map_or(0.0, |drive| drive.travel);
        let mut slopes = [0.0; PARAMETERS];
        for (i, (place, drive)) in slopes.iter_mut().zip(drives.iter().skip(1)).enumerate() {
            if part_free(&self.free, i) {
                *place = (drive.travel - travel) / step(vector, i);
            }
        }
        slopes
    }

    /// Runs drives through a chunk; `see` gets the first one's error after each record.
    fn run(
        &self,
        (start, end): (usize, usize),
        drives: &mut [Drive],
        mut see: impl FnMut(f64, &[Drive]),
    ) {
        let mut travel = 0.0;
        for drive in &mut *drives {
            drive.travel = 0.0;
        }
        for index in start..end {
            let Some(record) = self.records.get(index) else {
                return;
            };
            travel += record.travel_d;
            for drive in &mut *drives {
                drive.step(|at| self.command(at), index as isize);
            }
            let model = drives.first().map_or(0.0, |drive| drive.travel);
            see(travel - model, drives);
        }
    }

    fn command(&self, index: isize) -> f64 {
        self.records.command(index)
    }

    /// Stretches from one rest to the next.
    fn chunks(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let mut from = 0;
        core::iter::from_fn(move || {
            let start = from;
            if start >= self.records.len() {
                return None;
            }
            let mut index = start;
            let mut zeros = 0_usize;
            let mut moved = false;
            while index < self.records.len() {
                let moves = self.command(index as isize) != 0.0;
                if moves && moved && zeros >= REST {
                    break;
                }
                zeros = if moves { 0 } else { zeros.wrapping_add(1) };
                moved |= moves;
                index = index.wrapping_add(1);
            }
            from = index;
            Some((start, index))
        })
    }

    /// Errors of a solution record by record, d: measured and modelled travel within its chunk.
    pub fn trace(&self, vector: &Vector, mut see: impl FnMut(usize, f64, f64, f64)) {
        let mut drive = [self.drive(vector)];
        for chunk in self.chunks() {
            let mut index = chunk.0;
            let mut last = 0.0;
            self.run(chunk, &mut drive, |error, drives| {
                let drive = drives.first().copied().unwrap_or_default();
                let travel = drive.travel + error;
                see(index, travel - last, drive.velocity(), error);
                last = travel;
                index = index.wrapping_add(1);
            });
        }
    }
}

fn part_free(free: &Free, place: usize) -> bool {
    free.get(place).copied().unwrap_or(false)
}

/// By how much a parameter is moved to see what follows.
fn step(vector: &Vector, place: usize) -> f64 {
    match place {
        place::GAIN => 1e-4 * part(vector, place::GAIN),
        place::DRIFT | place::FRICTION => 1e-5 * part(vector, place::GAIN),
        place::LN_OMEGA | place::LN_DAMPING => 1e-4,
        place::MAX_ACCELERATION => 1e-3 * part(vector, place),
        _ => 0.02,
    }
}
