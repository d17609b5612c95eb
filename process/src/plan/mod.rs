//! `leadscrew plan`: which encoder, which feed on which radius, which control cycle (P1 5 to 8, P3).
//!
//! [`catalogue`] has machines and encoders, [`cycle`] the formulas of P3, [`figures`] puts them together, as [`results`], with those of P1, which
//! the core has ([`leadscrew::units`]), [`board`] says where this firmware runs it, [`curves`] gives the figures of P3.

pub mod board;
pub mod catalogue;
pub mod curves;
pub mod cycle;
pub mod figures;
pub mod results;

pub use board::{BoardVerdict, Runs};
pub use catalogue::{Catalogue, Encoder, FittedEncoder, Machine, MachineAxis, Spindle};
pub use cycle::{Kinematics, Limit, RationalCycle};
pub use figures::Question;
pub use results::{AxisPlan, Contour, EncoderPlan, MachinePlan, SpindlePlan};
