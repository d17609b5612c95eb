//! Learning an encoder map on the host: the core's own calibration, on recordings and on simulated runs.

mod recordings;
mod simulated;
mod stretches;

pub use recordings::{Calibration, Curve, Left, Options, RunFigures, learn_from_recordings};
pub use simulated::{Procedure, learn_simulated};
pub use stretches::{Motion, Stretch};

use leadscrew::calibration::{Learned, Learner, Refusal, Work};
use leadscrew::capture::Unwrapper;
use leadscrew::encoder_map::check::{MapCheck, MapFit};
use leadscrew::encoder_map::error::EncodeError;
use leadscrew::encoder_map::format::image_len;
use leadscrew::encoder_map::{EncoderMap, Form};
use leadscrew::units::RangeError;
use leadscrew_hal_mock::learning::LearningError;
use thiserror::Error;

use crate::recording::Recording;
use crate::sampler::Sampler;

/// Why no map was learned.
#[derive(Debug, Error)]
pub enum CalibrationError {
    /// The data do not suffice.
    #[error("{0}")]
    Refused(#[from] Refusal),
    /// What was learned fits no map.
    #[error("{0}")]
    Encode(#[from] EncodeError),
    /// A simulated run that cannot be.
    #[error("{0}")]
    Range(#[from] RangeError),
    /// No steady stretch is long enough.
    #[error(
        "no run of {needed:.1} revolutions at one speed was found, the longest has {longest:.1}: hold a constant feed \
         for longer, check the edges per revolution, or name a flywheel's coast-down as such"
    )]
    NoRun {
        /// The longest stretch, revolutions.
        longest: f64,
        /// Revolutions needed.
        needed: f64,
    },
    /// A map of all edges was asked for, without an index.
    #[error(
        "without an index only the four phases can be learned: choose its channel with --z, or learn --form phases"
    )]
    NoIndexChannel,
    /// The index of a recording never rises.
    #[error(
        "the index is never high: choose another channel with --z, or learn --form phases without one"
    )]
    IndexNeverHigh {
        /// Number of the recording, from 0.
        recording: usize,
    },
    /// A run does not suffice.
    #[error("the run from {from_s:.2} to {to_s:.2} s: {cause}")]
    Run {
        /// Number of the recording, from 0.
        recording: usize,
        /// Its beginning, s.
        from_s: f64,
        /// Its end, s.
        to_s: f64,
        /// Why not.
        cause: Refusal,
    },
}

/// Work memory of a learner, on the heap.
#[derive(Debug)]
pub struct Memory {
    sums: Vec<i32>,
    mean: Vec<i16>,
}

impl Memory {
    /// For an encoder of `edges` a revolution.
    #[must_use]
    pub fn new(edges: u32) -> Self {
        Self {
            sums: vec![0; edges as usize],
            mean: vec![0; edges as usize],
        }
    }

    /// A learner of this encoder, times by a timer of `timer_hz`.
    ///
    /// # Errors
    /// Edges that cannot be mapped.
    pub fn learner(&mut self, timer_hz: f64) -> Result<Learner<'_>, Refusal> {
        let edges = self.sums.len() as u32;
        let work = Work {
            sums: &mut self.sums,
            mean: &mut self.mean,
        };
        Learner::new(edges, timer_hz, work)
    }
}

/// The image of the map that was learned.
///
/// # Errors
/// Errors that fit no map.
pub fn image(learned: &Learned<'_>, form: Form) -> Result<Vec<u8>, EncodeError> {
    let mut image = vec![0; image_len(learned.edges_per_revolution() as u32, form)];
    let length = learned.encode(form, &mut image)?;
    image.truncate(length);
    Ok(image)
}

impl From<LearningError> for CalibrationError {
    fn from(error: LearningError) -> Self {
        match error {
            LearningError::Range(error) => Self::Range(error),
            LearningError::Refused(refusal) => Self::Refused(refusal),
        }
    }
}

/// How well a map fits the encoder of a recording: what its edges are off their neighbours without the map and
/// with it.
#[must_use]
pub fn map_fit(recording: &Recording, tick_hz: f64, map: EncoderMap<'_>) -> MapFit {
    let mut sampler = Sampler::new(recording, tick_hz);
    let mut unwrapper = Unwrapper::new();
    let mut check = MapCheck::new(map);
    while let Some(capture) = sampler.next_capture() {
        check.feed(&unwrapper.unwrap(&capture));
    }
    check.fit()
}
