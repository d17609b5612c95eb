//! Why a drive cannot be identified, and what to do.

use core::fmt;

use super::experiment::Ending;
use super::stages::Stage;
use crate::axis::StartError;
use crate::units::RangeError;

/// Why identification ended without a result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// A parameter is out of range.
    Range(RangeError),
    /// Too little work memory.
    WorkMemory {
        /// Records that there is room for.
        given: usize,
        /// Records needed.
        needed: usize,
    },
    /// The encoder is too coarse for the distance of the proof.
    TooCoarse {
        /// The distance, d.
        proof_d: f64,
        /// What it must be, d.
        needed_d: f64,
    },
    /// The axis does not take an experiment.
    Start(StartError),
    /// A positive command makes the count fall.
    WrongPolarity {
        /// Command at which it showed, of full command.
        level: f64,
        /// Counts by which a positive pulse moved less than a negative one.
        moved_d: f64,
    },
    /// Nothing moves.
    NoMotion {
        /// Largest command tried, of full command.
        level: f64,
        /// Counts seen.
        moved_d: f64,
    },
    /// The axis left the small window of the proof of the sign.
    RunsAway {
        /// Command at which it did, of full command.
        level: f64,
    },
    /// An experiment did not come to its end.
    Ended {
        /// Which one.
        stage: Stage,
        /// How it ended.
        ending: Ending,
    },
    /// Friction takes most of what the window allows.
    WindowTooSmall {
        /// Largest command that the window allows.
        level: f64,
        /// Command needed.
        needed: f64,
    },
    /// The records do not determine a model.
    NotDetermined {
        /// Which ones.
        stage: Stage,
    },
    /// No drive of second order moves like this one.
    DoesNotFit {
        /// Rms of the difference, d.
        rms_d: f64,
        /// Largest allowed, d.
        limit_d: f64,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Range(error) => error.fmt(f),
            Self::WorkMemory { given, needed } => write!(
                f,
                "work memory for {given} records, {needed} are needed: give a larger slice"
            ),
            Self::TooCoarse { proof_d, needed_d } => write!(
                f,
                "proof_distance_mm is {proof_d:.1} d of this encoder, at least {needed_d:.0} are needed: enlarge it"
            ),
            Self::Start(error) => error.fmt(f),
            Self::WrongPolarity { level, moved_d } => write!(
                f,
                "wrong polarity: pulses of {:.1} % moved the axis by {moved_d:.0} d against their sign; exchange A and \
                 B of the encoder, or the wires of the command if the axis itself moves the wrong way; do not close \
                 the loop before",
                100.0 * level
            ),
            Self::NoMotion { level, moved_d } => write!(
                f,
                "no motion: pulses up to {:.1} % moved the count by {moved_d:.0} d. If the axis moved, the encoder, its \
                 coupling or its wiring is dead; if it stood, the drive is not enabled, gets no command, or the axis is \
                 blocked (brake, clamp, end of travel)",
                100.0 * level
            ),
            Self::RunsAway { level } => write!(
                f,
                "the axis ran on after a pulse of {:.1} %: its offset is too large, or the tachogenerator has the wrong \
                 polarity and the drive's own loop runs away; set the drive right first",
                100.0 * level
            ),
            Self::Ended { stage, ending } => {
                write!(f, "{stage}: {}", EndingText(ending))
            }
            Self::WindowTooSmall { level, needed } => write!(
                f,
                "the window allows {:.1} % of full command, {:.1} % are needed against friction: enlarge window_mm",
                100.0 * level,
                100.0 * needed
            ),
            Self::NotDetermined { stage } => write!(
                f,
                "{stage}: the motion does not determine a drive; is the axis free, the window large enough?"
            ),
            Self::DoesNotFit { rms_d, limit_d } => write!(
                f,
                "no velocity drive of second order moves like this: {rms_d:.1} d rms are left, allowed are \
                 {limit_d:.1} d; look at the drive's own tuning, play between motor and encoder, a slipping coupling"
            ),
        }
    }
}

struct EndingText(Ending);

impl fmt::Display for EndingText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            Ending::Complete => "complete",
            Ending::WindowLeft => "the axis left the window: enlarge window_mm, or lower max_level",
            Ending::TooFast => {
                "the axis was faster than max_feed_mm_per_min: raise it, or lower max_level"
            }
            Ending::TooLong => "it took too long",
            Ending::Aborted => "aborted",
            Ending::NotPermitted => {
                "the supervisor took the permit back: look at the fault, or enable the axis"
            }
        })
    }
}

impl core::error::Error for Refusal {}

impl From<RangeError> for Refusal {
    fn from(error: RangeError) -> Self {
        Self::Range(error)
    }
}

impl From<StartError> for Refusal {
    fn from(error: StartError) -> Self {
        Self::Start(error)
    }
}
