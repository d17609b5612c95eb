//! Limit switches, in the direction of motion: out of one the way is free.

use super::super::fault::Fault;
use super::super::record::Trip;
use crate::hal::Lines;

/// Judges the switches at the setpoint's and the estimated velocity; `still` is what a standing axis may seem to
/// have. All Q11.20 d/tick.
pub fn check(lines: &Lines, commanded: i32, estimated: i32, still: i32) -> Option<Trip> {
    let toward = |sign: i32| {
        let commanded = commanded.saturating_mul(sign);
        let estimated = estimated.saturating_mul(sign);
        let is_moving = commanded > 0 || estimated > still;
        let velocity = commanded.max(estimated);
        is_moving.then(|| Trip::of_bits(Fault::HardLimit, velocity, 0, 20))
    };
    let low = lines.limit_low.then(|| toward(-1)).flatten();
    low.or_else(|| lines.limit_high.then(|| toward(1)).flatten())
}
