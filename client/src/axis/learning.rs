//! Learning the encoder on the axis.

use leadscrew::calibration::{Bands, Disagreement, Refusal, Residual, RunSummary};
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;

use super::Axis;
use crate::error::Error;

/// How the learning stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LearningStatus {
    /// Where it is.
    pub phase: LearningPhase,
    /// Whole revolutions in the average.
    pub revolutions: u32,
    /// Runs that are complete.
    pub runs: u8,
    /// What the last run showed.
    pub last: Option<RunSummary>,
    /// Why the last run was dropped, or no map made.
    pub refusal: Option<Refusal>,
}

/// Where the learning is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LearningPhase {
    /// There is none.
    None,
    /// Between two runs.
    BetweenRuns,
    /// Waits for the index.
    WaitsForIndex,
    /// Measures the speed.
    Measures,
    /// Averages.
    Averages,
    /// The run is complete.
    RunComplete,
    /// A map is there.
    HasMap,
}

/// What was learned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Learned {
    /// The errors: what stays without a map, d rms.
    pub errors: Bands,
    /// Where runs disagree most.
    pub disagreement: Disagreement,
    /// Estimated errors of the map.
    pub residual: Residual,
    /// Bytes of its image.
    pub length: u32,
}

impl LearningStatus {
    const fn of(reply: &Reply<'_>) -> Option<Self> {
        let Reply::Learning {
            phase,
            revolutions,
            runs,
            last,
            refusal,
        } = *reply
        else {
            return None;
        };
        let phase = match phase {
            0 => LearningPhase::None,
            1 => LearningPhase::BetweenRuns,
            2 => LearningPhase::WaitsForIndex,
            3 => LearningPhase::Measures,
            4 => LearningPhase::Averages,
            5 => LearningPhase::RunComplete,
            6 => LearningPhase::HasMap,
            _ => return None,
        };
        Some(Self {
            phase,
            revolutions,
            runs,
            last,
            refusal,
        })
    }
}

impl Axis {
    /// Begins to learn an encoder with so many edges a revolution, on the work memory.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn learn(&mut self, edges: u32) -> Result<(), Error> {
        self.order(&Request::Learn { edges })
    }

    /// Begins a run over so many revolutions: the axis is to feed steadily from now on until it is complete.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn learn_run(&mut self, revolutions: u32) -> Result<(), Error> {
        self.order(&Request::LearnRun { revolutions })
    }

    /// Ends a run that is complete, while the axis stands, and tells what it showed.
    ///
    /// # Errors
    /// [`Error::Refused`] of a run that does not go with those before; [`Self::learning`] has the reason.
    pub fn end_learn_run(&mut self) -> Result<LearningStatus, Error> {
        self.order(&Request::EndRun {})?;
        self.learning()
    }

    /// How the learning stands.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn learning(&mut self) -> Result<LearningStatus, Error> {
        self.query(&Request::Learning {}, LearningStatus::of)
    }

    /// Makes the map of the runs, and tells what it is worth.
    ///
    /// # Errors
    /// [`Error::Refused`] if no map can be made; [`Self::learning`] has the reason.
    pub fn finish_learning(&mut self) -> Result<Learned, Error> {
        self.order(&Request::FinishLearning {})?;
        self.query(&Request::Learned {}, |reply| match *reply {
            Reply::Learned {
                errors,
                disagreement,
                residual,
                length,
            } => Some(Learned {
                errors,
                disagreement,
                residual,
                length,
            }),
            _ => None,
        })
    }

    /// Takes the learned map into use, while the axis is off. It is not saved yet.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn take_map(&mut self) -> Result<(), Error> {
        self.order(&Request::TakeMap {})
    }

    /// Saves the map that was taken into use, while the axis is off.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn save_map(&mut self) -> Result<(), Error> {
        self.order(&Request::SaveMap {})
    }

    /// Ends learning; what was learned and not taken is lost.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn end_learning(&mut self) -> Result<(), Error> {
        self.order(&Request::EndLearning {})
    }
}
