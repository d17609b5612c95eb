//! The least-squares polynomial through samples wherever they stand.
//!
//! ```text
//! s = [x,u]/[u,u]                                  slope of the line
//! c = ([x,u²] − β·[x,u]) / spread                  curvature; a = 2c
//! v = s − c·β                                      velocity at u = 0
//! x = (Σx − v·Σu − c·Σu²)/n                        place at u = 0
//! ```
//!
//! which are the normal equations of the quadratic x + v·u + c·u² solved by elimination; brackets, β and spread are those
//! of [`super::geometry`]. All brackets are exact integers. What the last fit says is taken off before anything is
//! rounded; what is then divided is small, so 29 bits of a quotient are enough.

use super::GRID_BITS;
use super::geometry::{BETA_FRAC, Geometry};
use super::window::PLACE_FRAC;
use crate::estimator::saturate;
use crate::units::Position;

/// Σ w, Σ w·tᵏ and Σ w·x·tᵏ, times in steps of the grid and places with [`PLACE_FRAC`] fractional bits. The weight w of a
/// sample is the number of its edges, up to [`MOST_WEIGHT`]: with more, they hardly differ.
///
/// A window reaches from −2⁷ to 2⁶ steps, so that of 64 samples the sums of powers fit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums {
    /// Samples.
    pub samples: usize,
    /// Σ w.
    pub weight: i32,
    pub t1: i32,
    pub t2: i32,
    pub t3: i32,
    pub t4: i64,
    pub x: i64,
    pub xt: i64,
    pub xt2: i64,
}

/// Largest weight of a sample.
pub const MOST_WEIGHT: u16 = 4;

impl Sums {
    #[inline]
    pub fn add(&mut self, time: i32, place: i32, edges: u16) {
        let weight = i32::from(edges.min(MOST_WEIGHT));
        let first = weight.wrapping_mul(time);
        let square = first.wrapping_mul(time);
        self.samples = self.samples.wrapping_add(1);
        self.weight = self.weight.wrapping_add(weight);
        self.t1 = self.t1.wrapping_add(first);
        self.t2 = self.t2.wrapping_add(square);
        self.t3 = self.t3.wrapping_add(square.wrapping_mul(time));
        self.t4 = self.t4.wrapping_add(wide(square, time.wrapping_mul(time)));
        self.x = self.x.wrapping_add(wide(place, weight));
        self.xt = self.xt.wrapping_add(wide(place, first));
        self.xt2 = self.xt2.wrapping_add(wide(place, square));
    }
}

/// A product that cannot overflow.
#[inline]
pub const fn wide(a: i32, b: i32) -> i64 {
    (a as i64).wrapping_mul(b as i64)
}

/// A product modulo 2⁶⁴.
#[inline]
pub const fn times(a: i64, b: i32) -> i64 {
    a.wrapping_mul(b as i64)
}

/// Polynomial of a window about the origin of its moments.
#[derive(Clone, Copy, Debug)]
pub struct Fit {
    /// Place at the origin from the base, Q.16 d.
    pub place: i64,
    /// Velocity at the origin, Q12.20 d/tick.
    pub velocity: i32,
    /// Acceleration, Q8.24 d/tick².
    pub acceleration: i32,
}

/// From places a step to Q.20 d a tick.
const OF_VELOCITY: u32 = 20 - PLACE_FRAC + GRID_BITS;
/// From places a step² to Q.24 d a tick², doubled as a = 2c.
const OF_ACCELERATION: u32 = 24 - PLACE_FRAC + 2 * GRID_BITS + 1;

impl Fit {
    /// Fits the samples of `of`, whose times have `geometry`. `velocity` (Q12.20 d/tick, at the origin) and
    /// `acceleration` (Q8.24 d/tick²) are about what is to be expected.
    #[inline]
    pub fn new(of: &Sums, geometry: &Geometry, velocity: i32, acceleration: i32) -> Self {
        let slope = velocity.wrapping_shr(OF_VELOCITY);
        let Sums { x, xt, xt2, .. } = *of;
        let xu = times(xt, of.weight)
            .wrapping_sub(times(x, of.t1))
            .wrapping_sub(times(geometry.uu, slope));
        let line = i64::from(slope)
            .wrapping_shl(OF_VELOCITY)
            .wrapping_add(i64::from(geometry.by_uu.ratio(xu, OF_VELOCITY)));
        let (acceleration, turned) = match geometry.by_spread {
            None => (0, 0),
            Some(by_spread) => {
                let curvature = acceleration.wrapping_shr(OF_ACCELERATION);
                let bend = times(xt2, of.weight)
                    .wrapping_sub(times(x, of.t2))
                    .wrapping_sub(times(geometry.u2u, slope))
                    .wrapping_sub(geometry.beta_times(xu))
                    .wrapping_sub(times(geometry.spread, curvature));
                let rest = by_spread.ratio(bend, OF_ACCELERATION);
                let acceleration = curvature.wrapping_shl(OF_ACCELERATION).saturating_add(rest);
                let turned = wide(acceleration, geometry.beta)
                    .wrapping_shr(BETA_FRAC + OF_ACCELERATION - OF_VELOCITY);
                (acceleration, turned)
            }
        };
        let velocity = saturate(line.wrapping_sub(turned));
        let rest = x
            .wrapping_sub(wide(velocity, of.t1).wrapping_shr(OF_VELOCITY))
            .wrapping_sub(wide(acceleration, of.t2).wrapping_shr(OF_ACCELERATION));
        Self {
            place: mean(rest, of.weight).wrapping_shl(Position::FRAC_NBITS - PLACE_FRAC),
            velocity,
            acceleration,
        }
    }
}

/// `sum`/`count` rounded to within 1, |sum| < 2⁴⁶ and 0 < count ≤ 256, by two 32-bit divisions.
#[inline]
fn mean(sum: i64, count: i32) -> i64 {
    let high = sum.wrapping_shr(16) as i32;
    let whole = high.checked_div(count).unwrap_or(0);
    let rest = high.wrapping_sub(whole.wrapping_mul(count));
    let low = rest.wrapping_shl(16).wrapping_add(i32::from(sum as u16));
    i64::from(whole)
        .wrapping_shl(16)
        .wrapping_add(i64::from(low.checked_div(count).unwrap_or(0)))
}
