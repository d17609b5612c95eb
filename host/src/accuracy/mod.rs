//! Estimators on prescribed motions of the encoder "real": error against the truth, lag by response, and the
//! table of figures.
//!
//! ```text
//! rows: motions ────────┐
//! columns: fit and lag ─┼─► run: one encoder, one way, all methods on the same edges ─► figures ─► text, JSON
//! maps: learned ────────┘    └─► anatomy of the samples ─► parts: where the error comes from
//! ```
//!
//! σ is the root of the mean square of estimate less truth at the instant that the estimate is for, bias included,
//! of the worst of five encoders in both directions. A further table is a field of [`Figures`], made in [`figures`]
//! and a section of [`Figures::to_text`].

mod anatomy;
mod bound;
mod columns;
mod error;
mod figures;
mod in_loop;
mod maps;
mod methods;
mod parts;
mod residue;
mod rows;
mod run;
mod table;
mod tally;
mod text;
mod trial;
mod two_edge;
mod variant;

pub use self::bound::BoundFigure;
pub use self::columns::{COLUMNS, Column, Quantity};
pub use self::error::AccuracyError;
pub use self::figures::{Cell, Figures, RowFigures, Stated, VariantFigures};
pub use self::in_loop::LoopRow;
pub use self::parts::Parts;
pub use self::rows::{ROWS, Row};
pub use self::table::figures;
pub use self::trial::{Observed, Trial};
pub use self::two_edge::{TwoEdge, TwoEdgeEstimate};
pub use self::variant::Variant;

/// Control rate of all scenes, Hz.
const TICK_HZ: f64 = 1000.0;
/// Encoders that a figure is the worst of.
const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];
