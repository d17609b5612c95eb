//! NC programs: read block by block, corrected by named terms, written back byte for byte.
//!
//! Lengths are mm, angles of rotary axes degrees, coordinates those of the machine unless a name says otherwise.
#![forbid(unsafe_code)]

pub mod block;
pub mod checks;
pub mod coordinates;
pub mod corrector;
pub mod csv_text;
pub mod dialect;
pub mod machine_state;
pub mod path;
pub mod setup;
pub mod source;
pub mod terms;
