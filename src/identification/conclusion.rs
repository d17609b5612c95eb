//! From the records of the main experiments to figures with their uncertainty.

use super::drive::{NO_LIMIT, Vector, converted, place};
use super::evidence::{Broke, broken_away_after};
use super::fit::{Fit, Problem};
use super::identified::{Figure, Identified, LargestAcceleration};
use super::matrix::{part, set};
use super::recorder::Records;
use super::seed;
use crate::units::AxisScale;

/// Dead times to begin with, of a natural period.
const DEAD_TIMES: [f64; 4] = [0.0, 0.03, 0.06, 0.15];
/// Limits of acceleration to begin with, of the largest acceleration without one.
const LIMIT_SHARES: [f64; 7] = [0.95, 0.85, 0.75, 0.65, 0.5, 0.35, 0.2];
/// A limit of acceleration must explain that share of the squares that are left without it.
const LIMIT_EXPLAINS: f64 = 0.05;
/// Most often that what breaks the axis away is judged anew, and the share by which it may still change at the end.
const ROUNDS: usize = 3;
const STAYS: f64 = 0.005;
/// Uncertainty of the period up to which it is well known.
const SURE_OF_PERIOD: f64 = 0.005;
/// Where else to begin if it is not: ln ω and delay (records) beside the fit's.
const AROUND: [(f64, f64); 4] = [(-0.7, -1.5), (-0.25, 0.0), (0.1, 0.5), (0.35, 0.0)];
/// Steps of command of common drives, of full command: what a ramp cannot tell apart.
const COMMAND_STEP: f64 = 1e-4;
/// Ticks by which the moment of breaking away is uncertain.
const BREAK_TICKS: f64 = 2.0;

/// All that is known at the end.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'r> {
    pub records: Records<'r>,
    pub decimation: u32,
    /// Model of the probe, ticks.
    pub probe: Vector,
    pub broke: [Option<Broke>; 2],
    pub break_command: Option<[f64; 2]>,
}

impl Evidence<'_> {
    /// The model in records, and static friction as the aim that breaks away, none where nothing holds the axis.
    pub fn solve(&self) -> Option<(Fit, Option<[f64; 2]>)> {
        let start = converted(&self.probe, 1, self.decimation);
        let free = self.solved(&start, None);
        let held = self.held(&start);
        let Some(held) = held else {
            return Some((free?, None));
        };
        let stuck = self.solved(&start, Some(held));
        let Some(stuck) = stuck else {
            return Some((free?, None));
        };
        let stuck = self.looked_around(stuck, Some(held));
        if free.is_some_and(|free| free.cost < stuck.cost) {
            return Some((free?, None));
        }
        // What breaks the axis away was judged by a rougher model: by the better one anew, until it stays.
        let (mut fit, mut held) = (stuck, Some(held));
        for _ in 0..ROUNDS {
            let anew = self.held(&fit.vector);
            let Some(better) = self.problem(&fit.vector, anew).solve(&fit.vector) else {
                break;
            };
            let is_same = stays(held, anew);
            (fit, held) = (better, anew);
            if is_same {
                break;
            }
        }
        Some((self.looked_around(fit, held), held))
    }

    /// A fit that does not know the period well may sit in a valley beside the right one: others are begun to either side.
    fn looked_around(&self, fit: Fit, held: Option<[f64; 2]>) -> Fit {
        let spread = fit.covariance.at(place::LN_OMEGA, place::LN_OMEGA);
        let mut best = fit;
        if libm::sqrt(spread) > SURE_OF_PERIOD {
            for (away, delay) in AROUND {
                let mut start = fit.vector;
                set(&mut start, place::LN_OMEGA, |value| value + away);
                set(&mut start, place::DELAY, |value| (value + delay).max(0.0));
                set(&mut start, place::LN_DAMPING, |value| {
                    value.clamp(-1.2, 0.3)
                });
                let friction = part(&start, place::FRICTION).max(1e-3 * part(&start, place::GAIN));
                set(&mut start, place::LN_STRIBECK, |_| libm::log(friction));
                if let Some(other) = self.solved(&start, held)
                    && other.cost < best.cost
                {
                    best = other;
                }
            }
        }
        best
    }

    /// The better of a drive with a limit of acceleration and one without.
    fn solved(&self, start: &Vector, held: Option<[f64; 2]>) -> Option<Fit> {
        let mut start = *start;
        let period = core::f64::consts::TAU / libm::exp(part(&start, place::LN_OMEGA));
        let unlimited = self.problem(&start, held);
        let peak = unlimited.peak_acceleration(&start);
        let mut least = f64::MAX;
        let mut nearest = start;
        for share in LIMIT_SHARES {
            for dead in DEAD_TIMES {
                set(&mut start, place::DEAD_TIME, |_| dead * period);
                set(&mut start, place::MAX_ACCELERATION, |_| share * peak);
                let cost = unlimited.cost(&start);
                if cost < least {
                    (least, nearest) = (cost, start);
                }
            }
        }
        let limited = self.problem(&nearest, held).solve(&nearest);
        set(&mut nearest, place::MAX_ACCELERATION, |_| NO_LIMIT);
        let without = unlimited.solve(&nearest);
        let (Some(limited), Some(without)) = (limited, without) else {
            return limited.or(without);
        };
        let limit = part(&limited.vector, place::MAX_ACCELERATION);
        let explains = limited.cost < (1.0 - LIMIT_EXPLAINS) * without.cost;
        let reached = explains && limited.peak_acceleration >= 0.999 * limit;
        Some(if reached { limited } else { without })
    }

    fn problem(&self, vector: &Vector, held: Option<[f64; 2]>) -> Problem<'_> {
        let friction = part(vector, place::FRICTION);
        let excess = held.map_or(0.0, |[forward, backward]| forward.min(backward) - friction);
        let gain = part(vector, place::GAIN);
        let limited = part(vector, place::MAX_ACCELERATION) < NO_LIMIT;
        let stribeck = excess > 0.1 * friction && excess > 5e-4 * gain;
        Problem {
            records: self.records,
            free: seed::main_free(limited, stribeck),
            held,
            ln_stribeck: libm::log(friction.max(1e-3 * gain)),
        }
    }

    /// Static friction of a drive with that vector (records) which breaks away when this one did.
    fn held(&self, vector: &Vector) -> Option<[f64; 2]> {
        let ticks = converted(vector, self.decimation, 1);
        let (gain, drift) = (part(&ticks, place::GAIN), part(&ticks, place::DRIFT));
        let [forward, backward] = seed::held(gain, drift, self.break_command)?;
        let [broke_forward, broke_backward] = self.broke;
        let records = f64::from(self.decimation);
        let forward = exact(&ticks, forward, broke_forward, 1.0);
        let backward = exact(&ticks, backward, broke_backward, -1.0);
        // Below the kinetic friction it makes no difference.
        let kinetic = part(&ticks, place::FRICTION);
        Some([forward, backward].map(|aim| aim.max(kinetic) * records))
    }

    /// The figures, in d, ticks and s.
    pub fn identified(
        &self,
        fit: &Fit,
        held: Option<[f64; 2]>,
        scale: AxisScale,
        proof_level: f64,
    ) -> Identified {
        let n = f64::from(self.decimation);
        let record_s = n / scale.tick_hz();
        let at = |place| part(&fit.vector, place);
        let sigma = |place| libm::sqrt(fit.covariance.at(place, place));
        let figure = |place, factor: f64| Figure {
            value: at(place) * factor,
            sigma: sigma(place) * factor,
        };
        let relative = |place, value: f64| Figure {
            value,
            sigma: value * sigma(place),
        };
        let [gain, drift, friction] = [place::GAIN, place::DRIFT, place::FRICTION];
        let sum = |weights: [f64; 3]| combined(fit, weights, n);
        let slower = -libm::copysign(1.0, at(drift));
        let full = sum([1.0, slower, -1.0]);
        let offset = at(drift) / at(gain);
        // Of the first order in both.
        let offset_sigma = combined(fit, [-offset, 1.0, 0.0], 1.0).sigma / at(gain);
        let speed = at(place::GAIN) / n;
        let aim = |broke: Option<Broke>, held: Option<f64>| {
            Some(Figure {
                value: held? / n,
                sigma: speed * (BREAK_TICKS * broke?.slope + COMMAND_STEP / 2.0),
            })
        };
        let [broke_forward, broke_backward] = self.broke;
        let (forward, backward) = (held.map(|[aim, _]| aim), held.map(|[_, aim]| aim));
        let limit = at(place::MAX_ACCELERATION);
        let has_stribeck = sigma(place::LN_STRIBECK) > 0.0;
        Identified {
            scale,
            gain: figure(gain, 1.0 / n),
            full_speed: full,
            offset: Figure {
                value: offset,
                sigma: offset_sigma,
            },
            friction: figure(friction, 1.0 / n),
            loss: [sum([0.0, -1.0, 1.0]), sum([0.0, 1.0, 1.0])],
            breakaway: [aim(broke_forward, forward), aim(broke_backward, backward)],
            stribeck: has_stribeck
                .then(|| relative(place::LN_STRIBECK, libm::exp(at(place::LN_STRIBECK)) / n)),
            natural_period_s: relative(
                place::LN_OMEGA,
                core::f64::consts::TAU / libm::exp(at(place::LN_OMEGA)) * record_s,
            ),
            damping: relative(place::LN_DAMPING, libm::exp(at(place::LN_DAMPING))),
            delay_s: figure(place::DELAY, record_s),
            dead_time_s: figure(place::DEAD_TIME, record_s),
            largest_acceleration: if limit < NO_LIMIT {
                LargestAcceleration::Reached(figure(place::MAX_ACCELERATION, 1.0 / (n * n)))
            } else {
                LargestAcceleration::AtLeast(fit.peak_acceleration / (n * n))
            },
            residual_d: fit.rms_d,
            proof_level,
        }
    }
}

/// Static friction of two models is the same.
fn stays(before: Option<[f64; 2]>, after: Option<[f64; 2]>) -> bool {
    let (Some([forward, backward]), Some([ahead, behind])) = (before, after) else {
        return true;
    };
    let same = |one: f64, other: f64| libm::fabs(one - other) <= STAYS * other;
    same(forward, ahead) && same(backward, behind)
}

/// A weighted sum of gain, drift and friction, a tick.
fn combined(fit: &Fit, weights: [f64; 3], ticks: f64) -> Figure {
    let mut value = 0.0;
    let mut variance = 0.0;
    for (i, a) in weights.into_iter().enumerate() {
        value += a * part(&fit.vector, i);
        for (j, b) in weights.into_iter().enumerate() {
            variance += a * b * fit.covariance.at(i, j);
        }
    }
    Figure {
        value: value / ticks,
        sigma: libm::sqrt(variance.max(0.0)) / ticks,
    }
}

/// Static friction in one direction, d/tick of aim, with which the ramp breaks the drive away in as many ticks.
fn exact(ticks: &Vector, rough: f64, broke: Option<Broke>, sign: f64) -> f64 {
    let Some(broke) = broke else {
        return rough;
    };
    let most = broke.ticks.saturating_mul(2).saturating_add(100);
    let after = |held: f64| broken_away_after(ticks, held, sign * broke.slope, most);
    let (mut low, mut high) = (0.0, 2.0 * rough + 0.1);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if after(middle) < broke.ticks {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
