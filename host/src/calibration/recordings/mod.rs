//! Learning from recordings of a real encoder.

mod curve;
mod feed;
mod phases;

use leadscrew::calibration::{
    Bands, Disagreement, MAX_RUNS, MIN_REVOLUTIONS, Noise, Refusal, Requirements, RunPlan,
    RunSummary,
};
use leadscrew::encoder_map::{Direction, EncoderMap, Form, Residual};

use super::stretches::{self, Motion, Stretch};
use super::{CalibrationError, Memory, image};
use crate::recording::Recording;
use crate::sampler::Sampler;

pub use curve::Curve;
use feed::learn;

/// Revolutions that a run takes besides those of its average: up to the index, and two for the speed; a quarter
/// since stretches are known to a quarter.
const BESIDES: f64 = 3.25;

/// What is to be learned, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// Edges of a revolution (x4).
    pub edges: u32,
    /// Rate at which recordings are sampled, Hz.
    pub tick_hz: f64,
    /// How the shaft moves in the runs.
    pub motion: Motion,
    /// How much the map is to know.
    pub form: Form,
    /// The recordings have an index; without one only [`Form::Phases`] can be learned.
    pub indexed: bool,
    /// What the map must satisfy.
    pub requirements: Requirements,
    /// Learn once more to see what a map without the last run leaves on it.
    pub curve: bool,
}

/// A run that was used.
#[derive(Clone, Debug)]
pub struct RunFigures {
    /// Number of its recording, from 0.
    pub recording: usize,
    /// Where it lies.
    pub stretch: Stretch,
    /// What it gave.
    pub summary: RunSummary,
}

/// A stretch that was not used.
#[derive(Clone, Debug)]
pub struct Left {
    /// Number of its recording, from 0.
    pub recording: usize,
    /// Where it lies.
    pub stretch: Stretch,
    /// There were enough without it; otherwise it is too short.
    pub enough: bool,
}

/// A learned map and what is known of it.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// The image of the map.
    pub image: Vec<u8>,
    /// The runs, in their order.
    pub runs: Vec<RunFigures>,
    /// Stretches that were not used.
    pub left: Vec<Left>,
    /// Errors of the encoder, the four phases apart, d rms.
    pub errors: Bands,
    /// Mean errors of the four phases forward and backward, d; none without a run that way.
    pub phases_d: [Option<[f64; 4]>; 2],
    /// What the map leaves, as it says itself.
    pub residual: Residual,
    /// Where the runs disagree most; none without index.
    pub disagreement: Option<Disagreement>,
    /// Noise by place and by time; none at one speed or without index.
    pub noise: Option<Noise>,
    /// Hysteresis of A less that of B, d; none with one direction.
    pub hysteresis_a_less_b_d: Option<f64>,
    /// Edge by edge, if it was asked for and there are two runs in one direction.
    pub curve: Option<Curve>,
}

/// A run to be: where it lies and how long its average is.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    recording: usize,
    stretch: Stretch,
}

impl Candidate {
    /// Revolutions that its average may take.
    fn revolutions(&self) -> u32 {
        (self.stretch.revolutions - BESIDES).max(0.0) as u32
    }

    const fn plan(motion: Motion, revolutions: u32) -> RunPlan {
        match motion {
            Motion::Steady => RunPlan::steady(revolutions),
            Motion::Coast => RunPlan::coast(revolutions),
        }
    }
}

/// Learns a map from all steady stretches of the recordings that are long enough, up to [`MAX_RUNS`].
///
/// # Errors
/// Recordings that do not suffice.
pub fn learn_from_recordings(
    recordings: &[Recording],
    options: &Options,
) -> Result<Calibration, CalibrationError> {
    if options.indexed {
        check_index(recordings)?;
    } else if options.form != Form::Phases {
        return Err(CalibrationError::NoIndexChannel);
    }
    let (used, left) = candidates(recordings, options)?;
    if !options.indexed {
        return phases::learn(recordings, options, &used, left);
    }
    let mut memory = Memory::new(options.edges);
    let mut learner = memory.learner(timer_hz(recordings) as f64)?;
    let mut runs = Vec::new();
    for candidate in &used {
        runs.push(learn(&mut learner, recordings, options, candidate, None)?);
    }
    let learned = learner.finish(&options.requirements)?;
    let report = learned.report();
    let phases_of = |direction| {
        let known = learned.index_front(direction).is_some();
        known.then(|| learned.phases_d(direction))
    };
    let image = image(&learned, options.form)?;
    let curve = if options.curve {
        curve::learn(recordings, options, &used)?
    } else {
        None
    };
    Ok(Calibration {
        residual: EncoderMap::from_bytes(&image)
            .map_or_else(|_| Residual::default(), |map| *map.residual()),
        image,
        runs,
        left,
        errors: report.errors,
        phases_d: [
            phases_of(Direction::Forward),
            phases_of(Direction::Backward),
        ],
        disagreement: Some(report.disagreement).filter(|found| found.order > 0),
        noise: report.noise,
        hysteresis_a_less_b_d: report.hysteresis_a_less_b_d,
        curve,
    })
}

/// Refuses recordings in which Z never rises.
fn check_index(recordings: &[Recording]) -> Result<(), CalibrationError> {
    let has_index = |recording: &Recording| recording.changes.iter().any(|change| change.levels.z);
    match recordings
        .iter()
        .position(|recording| !has_index(recording))
    {
        Some(recording) => Err(CalibrationError::IndexNeverHigh { recording }),
        None => Ok(()),
    }
}

/// One clock for all recordings: the finest.
fn timer_hz(recordings: &[Recording]) -> u64 {
    let clocks = recordings
        .iter()
        .map(|recording| Sampler::new(recording, 1000.0).timer_hz());
    clocks.max().unwrap_or(1_000_000)
}

/// The longest stretches in their order, and those left.
fn candidates(
    recordings: &[Recording],
    options: &Options,
) -> Result<(Vec<Candidate>, Vec<Left>), CalibrationError> {
    let mut all = Vec::new();
    for (number, recording) in recordings.iter().enumerate() {
        let found = stretches::find(recording, options.tick_hz, options.edges, options.motion);
        all.extend(found.into_iter().map(|stretch| Candidate {
            recording: number,
            stretch,
        }));
    }
    let mut by_length: Vec<usize> = (0..all.len())
        .filter(|&number| all[number].revolutions() >= MIN_REVOLUTIONS)
        .collect();
    if by_length.is_empty() {
        let longest = all
            .iter()
            .map(|found| found.stretch.revolutions)
            .fold(0.0, f64::max);
        return Err(CalibrationError::NoRun {
            longest,
            needed: f64::from(MIN_REVOLUTIONS) + BESIDES,
        });
    }
    by_length.sort_by(|&a, &b| {
        all[b]
            .stretch
            .revolutions
            .total_cmp(&all[a].stretch.revolutions)
    });
    by_length.truncate(MAX_RUNS);
    let (mut used, mut left) = (Vec::new(), Vec::new());
    for (number, candidate) in all.into_iter().enumerate() {
        if by_length.contains(&number) {
            used.push(candidate);
        } else {
            left.push(Left {
                recording: candidate.recording,
                stretch: candidate.stretch,
                enough: candidate.revolutions() >= MIN_REVOLUTIONS,
            });
        }
    }
    Ok((used, left))
}

/// The error of a run that was refused.
fn refused(candidate: &Candidate, options: &Options, cause: Refusal) -> CalibrationError {
    CalibrationError::Run {
        recording: candidate.recording,
        from_s: candidate.stretch.from as f64 / options.tick_hz,
        to_s: candidate.stretch.to as f64 / options.tick_hz,
        cause,
    }
}
