//! Gains and covariances of a Kalman filter in its steady state, in `f64`, at configuration.
//!
//! The state is x, v, a in d and ticks, and δ, the jerk that the disturbance causes. Over a tick the jerk is
//! taken for constant: j = −k₁·v − k₂·a + δ (+ k₁·G·u). An edge at age τ measures x − v·τ + a·τ²/2.

/// Four numbers, one for each of x, v, a, δ.
pub type Vector = [f64; 4];
/// Rows.
pub type Matrix = [Vector; 4];

/// Age at which the gains are computed: the mean of an edge's.
pub const MEAN_AGE: f64 = 0.5;
/// Rounds after which an iteration ends in any case.
pub const MAX_ROUNDS: u32 = 400;
/// Change of a covariance, relative to its diagonal, below which it has settled.
const SETTLED: f64 = 1e-6;

/// A model of motion over one tick.
#[derive(Clone, Copy, Debug)]
pub struct Dynamics {
    /// Jerk for each of x, v, a, δ.
    pub jerk: Vector,
    /// Standard deviation of the unexplained jerk in a tick.
    pub jerk_noise: f64,
    /// Standard deviation of the change of δ in a tick.
    pub disturbance_noise: f64,
}

/// What a filter in its steady state is like.
#[derive(Clone, Copy, Debug, Default)]
pub struct Steady {
    /// Correction of x, v, a, δ for an innovation of 1 d.
    pub gains: Vector,
    /// Variance of v and a on a drive that has its figures, between two corrections.
    pub variances: [f64; 2],
    /// Variance of the innovation on a drive that has its figures.
    pub innovation: f64,
}

impl Dynamics {
    /// The same with `share` of its noise.
    pub fn calmed(&self, share: f64) -> Self {
        Self {
            jerk_noise: self.jerk_noise * share,
            disturbance_noise: self.disturbance_noise * share,
            ..*self
        }
    }

    /// F: the state a tick later.
    pub fn transition(&self) -> Matrix {
        let [by_x, by_v, by_a, by_d] = self.jerk;
        let row = |start: Vector, share: f64| {
            let [x, v, a, d] = start;
            [
                x + share * by_x,
                v + share * by_v,
                a + share * by_a,
                d + share * by_d,
            ]
        };
        [
            row([1.0, 1.0, 0.5, 0.0], 1.0 / 6.0),
            row([0.0, 1.0, 1.0, 0.0], 0.5),
            row([0.0, 0.0, 1.0, 0.0], 1.0),
            [0.0, 0.0, 0.0, 1.0],
        ]
    }

    /// Q: what a tick adds to the covariance.
    fn noise(&self) -> Matrix {
        let by_jerk = [1.0 / 6.0, 0.5, 1.0, 0.0].map(|share| share * self.jerk_noise);
        let by_disturbance = [0.0, 0.0, 0.0, self.disturbance_noise];
        sum(
            &outer(&by_jerk, &by_jerk),
            &outer(&by_disturbance, &by_disturbance),
        )
    }

    /// F and Q over `gap` ticks, a power of two.
    #[inline(never)]
    fn over(&self, gap: u32) -> (Matrix, Matrix) {
        let (mut transition, mut noise) = (self.transition(), self.noise());
        for _ in 0..gap.ilog2() {
            noise = propagated(&noise, &transition, &noise);
            transition = product(&transition, &transposed(&transition));
        }
        (transition, noise)
    }

    /// The filter that corrects every `gap` ticks, a power of two, by a measurement of variance `variance`; `guess` is the
    /// covariance after a correction that the iteration starts from, and becomes that which it ends at.
    #[inline(never)]
    pub fn steady(&self, gap: u32, variance: f64, guess: &mut Matrix) -> Steady {
        let (transition, noise) = self.over(gap);
        let mut gains = [0.0; 4];
        for _ in 0..MAX_ROUNDS {
            let before = propagated(guess, &transition, &noise);
            let seen = before.map(|row| dot(&row, &MEASURED));
            gains = seen.map(|share| share / (dot(&MEASURED, &seen) + variance));
            let after = corrected(&before, &gains, variance);
            let settled = has_settled(guess, &after);
            *guess = after;
            if settled {
                break;
            }
        }
        self.stated(gap, variance, gains)
    }

    /// Ticks after which the filter of one edge a tick has forgotten an error to 1e-6.
    pub fn settling_ticks(&self, gains: &Vector) -> u32 {
        let transition = self.transition();
        let kept = sum(&IDENTITY, &outer(&gains.map(|gain| -gain), &MEASURED));
        let mut error: Vector = [1.0, 0.1, 0.01, 0.0];
        for tick in 0..MAX_SETTLING {
            let [x, v, a, _] = error;
            if x.abs().max(v.abs()).max(a.abs()) < 1e-6 {
                return tick;
            }
            let carried = transition.map(|row| dot(&row, &error));
            error = kept.map(|row| dot(&row, &carried));
        }
        MAX_SETTLING
    }

    /// What measurement noise, and a small share of the model's, does to the filter of those gains.
    #[inline(never)]
    fn stated(&self, gap: u32, variance: f64, gains: Vector) -> Steady {
        let calm = self.calmed(STATED_SHARE);
        let (transition, noise) = calm.over(gap);
        let mut covariance = [[0.0; 4]; 4];
        let mut innovation = variance;
        for _ in 0..MAX_ROUNDS {
            let before = propagated(&covariance, &transition, &noise);
            innovation = dot(&MEASURED, &before.map(|row| dot(&row, &MEASURED))) + variance;
            let after = corrected(&before, &gains, variance);
            let settled = has_settled(&covariance, &after);
            covariance = after;
            if settled {
                break;
            }
        }
        // On average it is half a gap old.
        if gap > 1 {
            let (transition, noise) = calm.over(gap.wrapping_shr(1));
            covariance = propagated(&covariance, &transition, &noise);
        }
        let [_, [_, v, ..], [_, _, a, _], _] = covariance;
        Steady {
            gains,
            variances: [v, a],
            innovation,
        }
    }
}

/// Longest stated settling, ticks.
const MAX_SETTLING: u32 = 10_000;
/// Share of the model's noise that the stated variances count on. The gains are for a drive that is off its figures;
/// on a drive that has them the errors are those of the edges and of about this.
const STATED_SHARE: f64 = 0.1;
/// H: what a measurement sees of x, v, a, δ.
const MEASURED: Vector = [1.0, -MEAN_AGE, MEAN_AGE * MEAN_AGE / 2.0, 0.0];

#[inline(never)]
fn propagated(covariance: &Matrix, transition: &Matrix, noise: &Matrix) -> Matrix {
    sum(
        &product(&product(transition, covariance), transition),
        noise,
    )
}

fn transposed(matrix: &Matrix) -> Matrix {
    product(&IDENTITY, matrix)
}

/// (1 − KH)·M·(1 − KH)ᵀ + K·R·Kᵀ.
#[inline(never)]
fn corrected(before: &Matrix, gains: &Vector, variance: f64) -> Matrix {
    let kept = sum(&IDENTITY, &outer(&gains.map(|gain| -gain), &MEASURED));
    let left = product(&product(&kept, before), &kept);
    sum(&left, &outer(gains, &gains.map(|gain| gain * variance)))
}

const IDENTITY: Matrix = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

/// Whether v and a, for which it is done, change no more.
fn has_settled(before: &Matrix, after: &Matrix) -> bool {
    let [_, [_, v, ..], [_, _, a, _], [.., d]] = *before;
    let [_, [_, next_v, ..], [_, _, next_a, _], [.., next_d]] = *after;
    [(v, next_v), (a, next_a), (d, next_d)]
        .iter()
        .all(|(before, after)| (after - before).abs() <= SETTLED * after)
}

#[inline(never)]
fn dot(one: &Vector, other: &Vector) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

/// One·otherᵀ. Like the rest not inlined: where `f64` is software, it is large.
#[inline(never)]
fn product(one: &Matrix, other: &Matrix) -> Matrix {
    one.map(|row| other.map(|column| dot(&row, &column)))
}

#[inline(never)]
fn outer(one: &Vector, other: &Vector) -> Matrix {
    one.map(|left| other.map(|right| left * right))
}

#[inline(never)]
fn sum(one: &Matrix, other: &Matrix) -> Matrix {
    let mut sum = *one;
    for (row, other) in sum.iter_mut().zip(other) {
        for (value, other) in row.iter_mut().zip(other) {
            *value += other;
        }
    }
    sum
}
