//! Metrology of parts against the papers' formulas, exact geometry and noise.

mod hand;
mod noise;
mod oracle;
mod papers;
mod part;
mod refusals;
mod rigid;
mod rs274;
mod support;
