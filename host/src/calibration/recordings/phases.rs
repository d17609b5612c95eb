//! An encoder without index: the mean errors of its four phases.
//!
//! Each run counts revolutions from a place of its own, so that runs have only their phases in common.

use leadscrew::calibration::{Bands, Requirements, RunSummary};
use leadscrew::encoder_map::encode::{MapContent, encode};
use leadscrew::encoder_map::format::image_len;
use leadscrew::encoder_map::{Direction, Form, Residual};

use super::feed::learn as feed;
use super::{Calibration, Candidate, Left, Options, timer_hz};
use crate::calibration::{CalibrationError, Memory};
use crate::recording::Recording;

/// Sums over runs, weighted by revolutions.
#[derive(Default)]
struct Sums {
    phases: [f64; 4],
    revolutions: f64,
}

impl Sums {
    fn mean(&self) -> Option<[f64; 4]> {
        let revolutions = self.revolutions;
        (revolutions > 0.0).then(|| self.phases.map(|sum| sum / revolutions))
    }
}

/// Learns the phases from runs that have no index.
pub fn learn(
    recordings: &[Recording],
    options: &Options,
    used: &[Candidate],
    left: Vec<Left>,
) -> Result<Calibration, CalibrationError> {
    let mut memory = Memory::new(options.edges);
    let mut sums: [Sums; 2] = Default::default();
    let (mut runs, mut residuals) = (Vec::new(), Vec::new());
    for candidate in used {
        let mut learner = memory.learner(timer_hz(recordings) as f64)?;
        let revolution = Some(options.edges);
        let figures = feed(&mut learner, recordings, options, candidate, revolution)?;
        let RunSummary {
            backward,
            revolutions,
            ..
        } = figures.summary;
        runs.push(figures);
        let learned = learner.finish(&Requirements::NONE)?;
        let direction = if backward {
            Direction::Backward
        } else {
            Direction::Forward
        };
        let phases = learned.phases_d(direction);
        residuals.push(learned.residual(Form::Phases));
        let sum = &mut sums[usize::from(backward)];
        for (sum, phase) in sum.phases.iter_mut().zip(phases) {
            *sum += phase * f64::from(revolutions);
        }
        sum.revolutions += f64::from(revolutions);
    }
    let phases_d = sums.map(|sums| sums.mean());
    let [forward, backward] = phases_d;
    if options.requirements.both_directions && (forward.is_none() || backward.is_none()) {
        return Err(leadscrew::calibration::Refusal::OneDirection.into());
    }
    let known = [forward.or(backward), backward.or(forward)].map(Option::unwrap_or_default);
    let content = MapContent {
        edges: options.edges,
        error: &|_| 0,
        phases: known.map(|phases| phases.map(|phase| (phase * 65_536.0).round() as i32)),
        fronts: [None; 2],
        residual: mean_residual(&residuals),
    };
    let mut image = vec![0; image_len(options.edges, Form::Phases)];
    encode(&content, Form::Phases, &mut image)?;
    Ok(Calibration {
        image,
        errors: mean_errors(runs.iter().map(|run| run.summary.errors)),
        runs,
        left,
        phases_d,
        residual: content.residual,
        disagreement: None,
        noise: None,
        hysteresis_a_less_b_d: forward.zip(backward).map(hysteresis),
        curve: None,
    })
}

/// Of A (odd edges) less that of B.
fn hysteresis((forward, backward): ([f64; 4], [f64; 4])) -> f64 {
    let differences = forward
        .iter()
        .zip(backward)
        .map(|(forward, backward)| forward - backward);
    let signs = [-0.5, 0.5, -0.5, 0.5];
    differences
        .zip(signs)
        .map(|(difference, sign)| difference * sign)
        .sum()
}

/// Root of the mean square of each figure.
fn mean_residual(all: &[Residual]) -> Residual {
    let mean = |figure: fn(&Residual) -> f32| {
        let squares: f32 = all.iter().map(|one| figure(one) * figure(one)).sum();
        (squares / all.len().max(1) as f32).sqrt()
    };
    Residual {
        short_wave_d: mean(|one| one.short_wave_d),
        slope: mean(|one| one.slope),
        curvature_per_d: mean(|one| one.curvature_per_d),
        noise_d: mean(|one| one.noise_d),
        noise_s: mean(|one| one.noise_s),
        hysteresis_d: 0.0,
    }
}

fn mean_errors(all: impl Iterator<Item = Bands> + Clone) -> Bands {
    let mean = |figure: fn(&Bands) -> f64| {
        let squares: f64 = all.clone().map(|one| figure(&one) * figure(&one)).sum();
        (squares / all.clone().count().max(1) as f64).sqrt()
    };
    Bands {
        first: mean(|one| one.first),
        second: mean(|one| one.second),
        third_to_tenth: mean(|one| one.third_to_tenth),
        eleventh_to_32nd: mean(|one| one.eleventh_to_32nd),
        lines: mean(|one| one.lines),
        edges: mean(|one| one.edges),
    }
}
