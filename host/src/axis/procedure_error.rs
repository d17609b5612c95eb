//! Why a procedure on an axis ended without its result.

use leadscrew::calibration;
use leadscrew::identification;
use leadscrew::params::ParamError;
use leadscrew::tuning::autotune::AutotuneError;
use leadscrew::units::RangeError;
use thiserror::Error;

/// Why a procedure ended.
#[derive(Debug, Error)]
pub enum ProcedureError {
    /// The axis does not do it, or cannot be reached.
    #[error(transparent)]
    Axis(#[from] leadscrew_client::Error),
    /// The drive cannot be identified.
    #[error("{0}")]
    NotIdentified(identification::Refusal),
    /// A tick was lost on the way to the record, or there was no room.
    #[error(
        "the record of the experiment has a gap: the axis was too busy to record it. Lower the control rate, then repeat"
    )]
    Torn,
    /// No loop can be offered.
    #[error("{0}")]
    NotTuned(AutotuneError),
    /// The encoder cannot be learned.
    #[error("{0}")]
    NotLearned(calibration::Refusal),
    /// A parameter cannot be.
    #[error("{0}")]
    Param(#[from] ParamError),
    /// The axis has no loop that could hold it.
    #[error(
        "the axis has no loop yet (controller.position_gain_per_s is 0): run `autotune` first, or `setup` for all of it"
    )]
    NoLoop,
    /// There is no index, so no map can be learned.
    #[error(
        "motion.counts_per_revolution is {counts}, and a map takes an encoder with an index and 512 to {most} counts a revolution: \
         set it, or leave the map"
    )]
    NoDisc {
        /// What it is.
        counts: f64,
        /// Most that the axis can learn.
        most: u32,
    },
    /// Too little travel.
    #[error(
        "{what} takes {needed_mm:.1} mm, free are {free_mm:.1} mm ({low_mm:.1} to {high_mm:.1} mm where the axis is now at \
         {at_mm:.1}). {advice}"
    )]
    NoRoom {
        /// What takes it.
        what: &'static str,
        /// How much it takes, mm.
        needed_mm: f64,
        /// How much there is, mm.
        free_mm: f64,
        /// From where, mm.
        low_mm: f64,
        /// To where, mm.
        high_mm: f64,
        /// Where the axis is, mm.
        at_mm: f64,
        /// What to do.
        advice: &'static str,
    },
    /// The axis does not follow better.
    #[error(
        "with the new parameters the axis followed worse: {after_d:.1} d at most instead of {before_d:.1} d. The ones before are in \
         force again. Identify it anew, at its usual temperature and load"
    )]
    Worse {
        /// Largest following error before, d.
        before_d: f64,
        /// After, d.
        after_d: f64,
    },
    /// The axis did not get through the test move.
    #[error(
        "with the new parameters the test move failed: {cause}. The ones before are in force again. Identify the axis anew, or ask \
         for less feed or acceleration"
    )]
    Fails {
        /// What happened.
        cause: leadscrew_client::Error,
    },
    /// The carriage moves the other way.
    #[error(
        "plus is the other way. Exchange A and B of the encoder and the two wires of the command, both: the loop's sign stays \
         right, the direction turns round. Then begin anew"
    )]
    OtherWay,
    /// Counts between two indexes are not what was said.
    #[error(
        "from index to index the axis counts {found} d, {expected} d were expected. Check the number of lines of the encoder, its \
         coupling and the screen of its cable; give counts_per_revolution as it is, then begin anew"
    )]
    OtherRevolution {
        /// What it counts.
        found: i64,
        /// What was said.
        expected: f64,
    },
    /// No index came.
    #[error(
        "no index came within {travel_mm:.1} mm, {revolutions:.1} revolutions. Check the Z pair of the encoder; or answer \
         counts_per_revolution = 0 if it has none"
    )]
    NoIndex {
        /// Way that was gone, mm.
        travel_mm: f64,
        /// The same in revolutions.
        revolutions: f64,
    },
    /// The axis stands on a pulse.
    #[error(
        "the axis moved {moved_mm:.1} mm of {wanted_mm:.1} mm before its time was over. Is it clamped, or at the end of its travel?"
    )]
    Stuck {
        /// How far it came, mm.
        moved_mm: f64,
        /// How far it should have come, mm.
        wanted_mm: f64,
    },
    /// The person said no.
    #[error("not agreed: nothing further was done")]
    Declined,
    /// An answer that cannot be.
    #[error("{0}")]
    Answer(String),
}

impl From<identification::Refusal> for ProcedureError {
    fn from(refusal: identification::Refusal) -> Self {
        Self::NotIdentified(refusal)
    }
}

impl From<RangeError> for ProcedureError {
    fn from(error: RangeError) -> Self {
        Self::Param(error.into())
    }
}
