//! A first model, from the steps of the probe.

use super::drive::{NO_LIMIT, Vector, place};
use super::fit::{Fit, Free, Problem};
use super::recorder::Records;

/// Periods to try, s, and dampings.
const PERIODS_S: [f64; 8] = [0.012, 0.025, 0.045, 0.08, 0.13, 0.2, 0.32, 0.5];
const DAMPINGS: [f64; 3] = [0.3, 0.6, 1.1];
/// Delay to begin with, s.
const DELAY_S: f64 = 0.002;

/// What the fit of the probe looks for.
const FREE: Free = [true, true, true, true, true, true, false, false, false];

/// The probe's model in records of `record_s`; `break_command` are the commands that broke the axis away.
#[must_use]
pub fn fit(
    records: Records<'_>,
    levels: [f64; 2],
    break_command: Option<[f64; 2]>,
    record_s: f64,
) -> Option<Fit> {
    let [gain, drift, friction] = closed_form(records, levels)?;
    let held = held(gain, drift, break_command);
    let problem = Problem {
        records,
        free: FREE,
        held,
        ln_stribeck: libm::log(friction.max(1e-3 * gain)),
    };
    let mut start = [
        gain,
        drift,
        friction,
        0.0,
        0.0,
        DELAY_S / record_s,
        0.0,
        NO_LIMIT,
        problem.ln_stribeck,
    ];
    let mut best: Option<(f64, Vector)> = None;
    for period_s in PERIODS_S {
        for damping in DAMPINGS {
            let [.., ln_omega, ln_damping, _, _, _, _] = &mut start;
            *ln_omega = libm::log(core::f64::consts::TAU * record_s / period_s);
            *ln_damping = libm::log(damping);
            let cost = problem.cost(&start);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, start));
            }
        }
    }
    let (_, start) = best?;
    problem.solve(&start)
}

/// Static friction as the aim that breaks away.
#[must_use]
pub fn held(gain: f64, drift: f64, break_command: Option<[f64; 2]>) -> Option<[f64; 2]> {
    break_command.map(|[forward, backward]| {
        [gain * forward + drift, gain * backward - drift].map(|aim| aim.max(0.0))
    })
}

/// Gain, drift and friction from the speeds that steps at two levels settle at: v = G·u + b ∓ f.
fn closed_form(records: Records<'_>, [large, small]: [f64; 2]) -> Option<[f64; 3]> {
    let threshold = 0.5 * (large + small);
    let speed = |above: bool, sign: f64| {
        let driven = |u: f64| u * sign > 0.2 * small && (u * sign > threshold) == above;
        settled(records, driven)
    };
    let (up, down) = (speed(true, 1.0)?, speed(true, -1.0)?);
    let (slow_up, slow_down) = (speed(false, 1.0)?, speed(false, -1.0)?);
    let (fast, slow) = (0.5 * (up - down), 0.5 * (slow_up - slow_down));
    let drift = 0.25 * (up + down + slow_up + slow_down);
    let gain = (fast - slow) / (large - small);
    let least = fast / large;
    if !(gain.is_finite() && fast > 0.0) {
        return None;
    }
    // Steps that did not settle, or hardly moved, give nonsense: no friction then is a better beginning.
    let gain = if gain < 0.5 * least || gain > 3.0 * least {
        least
    } else {
        gain
    };
    Some([gain, drift, (gain * large - fast).max(0.0)])
}

/// Mean speed over the second half of the records that are driven so.
fn settled(records: Records<'_>, driven: impl Fn(f64) -> bool) -> Option<f64> {
    let count = records
        .iter()
        .filter(|record| driven(record.command))
        .count();
    let half = count / 2;
    let (mut sum, mut seen) = (0.0, 0.0);
    let chosen = records.iter().filter(|record| driven(record.command));
    for record in chosen.skip(half) {
        sum += record.travel_d;
        seen += 1.0;
    }
    (seen > 4.0).then(|| sum / seen)
}

/// Places of [`FREE`] and more, for the main fit.
#[must_use]
pub fn main_free(limit: bool, stribeck: bool) -> Free {
    let mut free = [true; super::drive::PARAMETERS];
    for (index, value) in free.iter_mut().enumerate() {
        *value = match index {
            place::MAX_ACCELERATION => limit,
            place::LN_STRIBECK => stribeck,
            _ => true,
        };
    }
    free
}
