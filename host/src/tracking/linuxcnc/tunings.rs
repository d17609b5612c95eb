//! The tunings of the peer that the tables show.

use super::bench::Bench;
use super::relay::Ultimate;
use super::{PidParams, hand};
use crate::tracking::error::TrackingError;
use crate::tracking::scene::Scene;

/// Effort of the relay, of full command: the drive stays below its largest acceleration.
const EFFORT: f64 = 0.1;

/// What a tuning is in the tables for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reference {
    /// Ours is judged against it.
    Judged,
    /// It is shown.
    Shown,
}

/// A tuning.
#[derive(Clone, Copy, Debug)]
pub struct Tuning {
    /// What it is called in a table.
    pub name: &'static str,
    /// The gains.
    pub params: PidParams,
    /// What it is there for.
    pub reference: Reference,
}

/// All tunings: by the relay rule, on the full nominal machine, and by hand.
///
/// # Errors
/// No limit cycle under the relay.
pub fn tunings() -> Result<[Tuning; 5], TrackingError> {
    let [_, full, ..] = Scene::of_moves();
    let bench = Bench::new(&full.nominal, &full.machine(), 1)?;
    let effort = EFFORT * bench.full_d_per_s();
    let ultimate = Ultimate::measure(bench, effort)?;
    let shown = |name, params| Tuning {
        name,
        params,
        reference: Reference::Shown,
    };
    Ok([
        shown("relay, PID", ultimate.with_derivative()),
        shown("relay, PI and FF1", ultimate.with_feedforward()),
        Tuning {
            reference: Reference::Judged,
            ..shown("hand", hand::WITH_MARGINS)
        },
        shown("hand, to the edge", hand::TO_THE_EDGE),
        shown("hand, for all three", hand::FOR_ALL),
    ])
}
