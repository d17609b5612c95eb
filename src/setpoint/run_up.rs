//! The run-up of a motion that follows another: a weight from 0 to 1, and what it makes of the motion followed.
//!
//! Over a span that goes from u = 0 to u = 1 (of time, or of the angle of a spindle) the weight is the shortest curve
//! of bounded second derivative with slope zero at both ends, w = 2u² up to the middle and 1 − 2(1 − u)² from there
//! on; w′ is at most 2 and w″ ±4. Its integral σ = 2u³/3 and u − ½ + 2(1 − u)³/3 ends at ½: whoever follows by w
//! makes half of the way, wherever u stood at which time.

use super::Setpoint;
use crate::estimator::saturate;
use crate::units::{Acceleration, Jerk, Velocity};

/// Fractional bits of u, w and σ.
pub const FRAC: u32 = 30;
/// u = 1.
pub const ONE: i32 = 1 << FRAC;
/// Fractional bits of the rate of u, a tick.
pub const RATE_FRAC: u32 = 33;
/// Fewest ticks of a run-up: the rate's format holds 2·rate.
pub const MIN_TICKS: f64 = 16.0;
const HALF: i32 = ONE >> 1;
/// 2³⁰·2/3.
const TWO_THIRDS: i32 = 715_827_883;
/// Fractional bits of w″.
const CURVE_FRAC: u32 = 36;

/// A motion that is followed, in d of the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Followed {
    /// Q12.20 d/tick.
    pub velocity: i32,
    /// Q8.24 d/tick².
    pub acceleration: i32,
}

/// The weight and its rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Weight {
    /// w, Q2.30.
    pub value: i32,
    /// dw/dt, Q.33 a tick.
    rate: i32,
    /// d²w/dt² at a steady rate of u, Q.36 a tick².
    curve: i32,
}

impl Weight {
    /// At `u`, 0 to [`ONE`], that goes by `rate` a tick, Q.33; |rate| stays within 1/16 a tick, or saturates.
    #[must_use]
    pub fn at(u: i32, rate: i32) -> Self {
        const MOST: i32 = 1 << (RATE_FRAC - 4);
        let rate = rate.clamp(-MOST, MOST);
        let is_rising = u < HALF;
        let side = if is_rising { u } else { ONE.wrapping_sub(u) };
        let twice_square = product(side, side, FRAC - 1);
        // 4·rate², Q.36 of Q.66.
        let curve = product(rate, rate, 2 * RATE_FRAC - CURVE_FRAC - 2);
        Self {
            value: if is_rising {
                twice_square
            } else {
                ONE.wrapping_sub(twice_square)
            },
            rate: product(side, rate, FRAC - 2),
            curve: if is_rising {
                curve
            } else {
                curve.wrapping_neg()
            },
        }
    }

    /// Velocity, acceleration and jerk of a motion of which this share is followed; its position is left out.
    #[must_use]
    pub fn of(&self, followed: &Followed) -> Setpoint {
        let Followed {
            velocity,
            acceleration,
        } = *followed;
        let share = product(acceleration, self.value, FRAC);
        let gained = product(
            velocity,
            self.rate,
            Velocity::FRAC_NBITS + RATE_FRAC - Acceleration::FRAC_NBITS,
        );
        let bent = product(
            velocity,
            self.curve,
            Velocity::FRAC_NBITS + CURVE_FRAC - Jerk::FRAC_NBITS,
        );
        let twisted = product(
            acceleration,
            self.rate,
            Acceleration::FRAC_NBITS + RATE_FRAC - Jerk::FRAC_NBITS,
        );
        Setpoint {
            velocity: Velocity::from_bits(product(velocity, self.value, FRAC)),
            acceleration: Acceleration::from_bits(share.saturating_add(gained)),
            jerk: Jerk::from_bits(bent.saturating_add(twisted.saturating_mul(2))),
            ..Setpoint::default()
        }
    }
}

/// σ(`u`), Q2.30.
#[must_use]
pub fn integral(u: i32) -> i32 {
    let is_rising = u < HALF;
    let side = if is_rising { u } else { ONE.wrapping_sub(u) };
    let cube = product(product(side, side, FRAC), side, FRAC);
    let bend = product(cube, TWO_THIRDS, FRAC);
    if is_rising {
        bend
    } else {
        u.wrapping_sub(HALF).wrapping_add(bend)
    }
}

/// Ticks of a run-up to `velocity` within `acceleration` and `jerk`: a = 2v/N, j = 4v/N².
#[must_use]
pub fn ticks(velocity: f64, acceleration: f64, jerk: f64) -> f64 {
    let by_acceleration = 2.0 * velocity / acceleration;
    let by_jerk = 2.0 * libm::sqrt(velocity / jerk);
    by_acceleration.max(by_jerk).max(MIN_TICKS)
}

/// a·b/2^`shift`, rounded to nearest.
#[inline]
const fn product(left: i32, right: i32, shift: u32) -> i32 {
    let half = 1_i64.wrapping_shl(shift.wrapping_sub(1));
    let wide = (left as i64).wrapping_mul(right as i64).wrapping_add(half);
    saturate(wide.wrapping_shr(shift))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weight_and_its_integral_are_the_curve() {
        let one = f64::from(ONE);
        let mut sum = 0.0;
        for step in 0..=1000 {
            let part = f64::from(step) / 1000.0;
            let u = (part * one) as i32;
            let exact = if part < 0.5 {
                2.0 * part * part
            } else {
                1.0 - 2.0 * (1.0 - part) * (1.0 - part)
            };
            let found = f64::from(Weight::at(u, 0).value) / one;
            assert!((found - exact).abs() < 1e-8, "{found} {exact}");
            let area = f64::from(integral(u)) / one;
            assert!((area - sum).abs() < 2e-6, "{area} {sum}");
            let next = part + 0.0005;
            sum += 0.001
                * if next < 0.5 {
                    2.0 * next * next
                } else {
                    1.0 - 2.0 * (1.0 - next) * (1.0 - next)
                };
        }
        assert_eq!((integral(0), integral(ONE)), (0, HALF));
        assert_eq!((Weight::at(0, 9).value, Weight::at(ONE, 9).value), (0, ONE));
    }
}
