//! Why a feature cannot be computed.

use thiserror::Error;

/// Why a feature cannot be computed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MetrologyError {
    /// Fewer touches than unknowns.
    #[error("{what} needs {needed} touches or more, found {found}")]
    TooFew {
        /// The feature.
        what: &'static str,
        /// Least number.
        needed: usize,
        /// Number given.
        found: usize,
    },
    /// The touches do not determine the unknowns.
    #[error(
        "{what} is not determined by these touches ({reason}; condition number {condition:.0e}): touch other places"
    )]
    Degenerate {
        /// The feature.
        what: &'static str,
        /// What arrangement does that.
        reason: String,
        /// Greatest over least singular value of the scaled equations.
        condition: f64,
    },
    /// The features do not go together, or see too little.
    #[error("{what} cannot be told: {reason}")]
    Impossible {
        /// The feature.
        what: &'static str,
        /// Why.
        reason: String,
    },
    /// A touch does not belong to the feature.
    #[error("touch {touch} of {what}: {reason}")]
    Misplaced {
        /// The feature.
        what: &'static str,
        /// Number of the touch, from 1.
        touch: usize,
        /// Why.
        reason: String,
    },
    /// Some touches have a stated 1σ, some have none.
    #[error("{with} of {all} touches of {what} state a 1σ: state it for all or for none")]
    MixedSigma {
        /// The feature.
        what: &'static str,
        /// Touches that state one.
        with: usize,
        /// All touches.
        all: usize,
    },
    /// The places found lie so far from the planned ones that the fit finds no end.
    #[error("{what} does not converge: the places found are far from the planned ones")]
    Diverges {
        /// The feature.
        what: &'static str,
    },
    /// A number is outside its range.
    #[error("{name} = {value} {unit}: expected {allowed}")]
    Range {
        /// What it is.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// What is allowed.
        allowed: String,
    },
}
