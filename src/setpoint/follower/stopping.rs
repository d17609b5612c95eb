//! How far a jerk-limited stop goes, bounded in the tick.
//!
//! With t₁ = |a|/j and Δv = |a|·t₁/2 the velocity after taking the acceleration back to zero is v + a·t₁/2; its sign
//! is the direction in which the stop ends, and v, a are counted in it. From v₀ = v + Δv without acceleration a stop
//! takes
//!
//! d(v₀) = v₀·√(v₀/j) up to v₀ = a_max²/j, and v₀/2·(v₀/a_max + τ) above, τ = a_max/j,
//!
//! and a state with an acceleration is on a stop from v₀ that lies t₁·(v + ⅔Δv) before it (a < 0), or comes to it
//! after that way (a > 0). In whole ticks the ramp to −a_max ends with a step of less than j. With φ the part of j
//! in it, the fraction of (a_max + a)/j, that takes v₀·φ(1 − φ)·j/(2·a_max) more; what rounding to ticks does to the
//! rest is less than a_max·(1 tick)².

use crate::setpoint::Setpoint;
use crate::units::Position;

/// Bits below a tick of t₁.
const TIME_FRAC: u32 = 10;
/// a·2⁻²⁴ · mantissa·2^(exponent − 32) is a time in ticks.
const MANTISSA_SHIFT: i32 = 56 - TIME_FRAC as i32;
/// A distance that no travel has, 2⁻¹⁶ d.
const BEYOND: i64 = 1 << 56;

/// What the distance of a stop follows from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stopping {
    /// Largest acceleration, 2⁻²⁴ d/tick².
    acceleration: u32,
    /// 1/j as mantissa and shift: t₁ in 2⁻¹⁰ ticks = (a·mantissa) >> shift, a in 2⁻²⁴ d/tick².
    per_jerk: u32,
    per_jerk_shift: u32,
    /// 1/√j, 2⁻¹⁷.
    per_root_jerk: u32,
    /// Up to this velocity the acceleration limit is not reached, 2⁻²⁰ d/tick.
    corner: u32,
    /// Bits below a tick of the duration of a stop.
    duration_frac: u32,
    /// 2³²·(duration per velocity), duration with its bits, velocity in 2⁻²⁰ d/tick.
    per_acceleration: u32,
    /// τ with the bits of the duration.
    ramp: u32,
    /// τ in 2⁻¹⁰ ticks.
    ramp_ticks: u32,
    /// j/(2·a_max), 2⁻¹².
    step_share: u32,
    /// Added for ticks and rounding, 2⁻¹⁶ d.
    slack: i64,
}

impl Stopping {
    /// From the largest acceleration and jerk, both within the range of their formats and not zero; the jerk at most
    /// twice the acceleration, which goes from one end to the other in a tick.
    pub(super) fn new(acceleration: f64, jerk: f64) -> Self {
        let (mantissa, exponent) = libm::frexp(1.0 / jerk);
        let ramp = acceleration / jerk;
        let longest = 4096.0 / acceleration + ramp;
        let (_, bits) = libm::frexp(longest);
        let duration_frac = 31_i32.saturating_sub(bits).clamp(0, 24);
        Self {
            acceleration: libm::ldexp(acceleration, 24) as u32,
            per_jerk: libm::ldexp(mantissa, 32) as u32,
            per_jerk_shift: MANTISSA_SHIFT
                .saturating_sub(exponent)
                .clamp(0, 63)
                .cast_unsigned(),
            per_root_jerk: libm::ceil(libm::ldexp(1.0 / libm::sqrt(jerk), 17)) as u32,
            corner: if ramp > 1.0 {
                libm::ldexp(acceleration * acceleration / jerk, 20) as u32
            } else {
                0
            },
            duration_frac: duration_frac.cast_unsigned(),
            per_acceleration: libm::ceil(libm::ldexp(
                1.0 / acceleration,
                duration_frac.saturating_add(12),
            )) as u32,
            ramp: libm::ceil(libm::ldexp(ramp, duration_frac)) as u32,
            ramp_ticks: libm::ldexp(ramp, TIME_FRAC.cast_signed()) as u32,
            step_share: libm::ceil(libm::ldexp(0.5 / ramp, 12)) as u32,
            slack: libm::ceil(libm::ldexp(acceleration + 1.0, 16)) as i64,
        }
    }

    /// The distance from `setpoint` whose acceleration will be `next_acceleration` (2⁻²⁴ d/tick²) a tick later.
    pub(super) fn distance(&self, setpoint: &Setpoint, next_acceleration: i32) -> Position {
        let velocity = setpoint.velocity.to_bits();
        let gain = setpoint
            .acceleration
            .to_bits()
            .wrapping_shr(1)
            .wrapping_add(next_acceleration.wrapping_shr(1))
            .wrapping_shr(4);
        let next = i64::from(velocity).wrapping_add(i64::from(gain));
        let tick = next.wrapping_add(i64::from(velocity)).wrapping_shr(5);

        let swing = self.ramp(next_acceleration.unsigned_abs()).swing();
        let end = if next_acceleration < 0 {
            next.wrapping_sub(swing)
        } else {
            next.wrapping_add(swing)
        };
        if end < 0 {
            let ahead = self.ahead(next.wrapping_neg(), next_acceleration.wrapping_neg());
            Position::from_bits(tick.wrapping_sub(ahead))
        } else {
            Position::from_bits(tick.wrapping_add(self.ahead(next, next_acceleration)))
        }
    }

    /// The distance to the end of a stop, 2⁻¹⁶ d, in the direction in which it ends.
    fn ahead(&self, velocity: i64, acceleration: i32) -> i64 {
        let magnitude = acceleration.unsigned_abs();
        let slows = acceleration < 0;
        // A greater deceleration than a stop may build up only ends it sooner.
        let ramp = self.ramp(if slows {
            magnitude.min(self.acceleration)
        } else {
            magnitude
        });
        let swing = ramp.swing();
        let start = velocity.wrapping_add(swing);
        let Ok(start) = u32::try_from(start) else {
            return BEYOND;
        };
        let two_thirds = swing.wrapping_mul(43_691).wrapping_shr(16);
        let covered = i64::from(ramp.ticks)
            .wrapping_mul(velocity.wrapping_add(two_thirds))
            .wrapping_shr(TIME_FRAC + 4);
        if slows {
            self.from(start, self.ramp_ticks.wrapping_sub(ramp.ticks))
                .wrapping_sub(covered)
        } else {
            self.from(start, self.ramp_ticks.wrapping_add(ramp.ticks))
                .wrapping_add(covered)
        }
    }

    fn ramp(&self, acceleration: u32) -> Ramp {
        let ticks = u64::from(acceleration)
            .wrapping_mul(u64::from(self.per_jerk))
            .wrapping_shr(self.per_jerk_shift);
        Ramp {
            acceleration,
            ticks: ticks.min(1 << 30) as u32,
        }
    }

    /// d(v₀) and what is added to it, 2⁻¹⁶ d; v₀ in 2⁻²⁰ d/tick. A ramp of `ramp_ticks` begins at the state itself.
    fn from(&self, velocity: u32, ramp_ticks: u32) -> i64 {
        let wide = u64::from(velocity);
        let distance = if velocity <= self.corner {
            let (root, shift) = root(velocity);
            let over = wide
                .wrapping_mul(u64::from(root))
                .wrapping_shr(shift.wrapping_add(16))
                .wrapping_add(1);
            over.wrapping_mul(u64::from(self.per_root_jerk))
                .wrapping_shr(15)
        } else {
            let duration = wide
                .wrapping_mul(u64::from(self.per_acceleration))
                .wrapping_shr(32)
                .wrapping_add(u64::from(self.ramp))
                .wrapping_add(1);
            let part = ramp_ticks & ((1 << TIME_FRAC) - 1);
            let step = part
                .wrapping_mul((1_u32 << TIME_FRAC).wrapping_sub(part))
                .wrapping_mul(self.step_share);
            wide.wrapping_mul(duration)
                .wrapping_shr(self.duration_frac.wrapping_add(5))
                .wrapping_add(
                    wide.wrapping_mul(u64::from(step))
                        .wrapping_shr(2 * TIME_FRAC + 16),
                )
        };
        distance.cast_signed().wrapping_add(self.slack)
    }
}

/// An acceleration and how long the jerk takes to bring it to zero.
struct Ramp {
    /// 2⁻²⁴ d/tick².
    acceleration: u32,
    /// 2⁻¹⁰ ticks.
    ticks: u32,
}

impl Ramp {
    /// Change of velocity, 2⁻²⁰ d/tick.
    fn swing(&self) -> i64 {
        u64::from(self.acceleration)
            .wrapping_mul(u64::from(self.ticks))
            .wrapping_shr(TIME_FRAC + 5)
            .cast_signed()
    }
}

/// √`value` as (root, shift): root·2^−shift, not below it. Two steps of Newton from a line that is within 3 %.
fn root(value: u32) -> (u32, u32) {
    let shift = value.leading_zeros() & !1;
    let scaled = value.wrapping_shl(shift);
    if scaled == 0 {
        return (0, 0);
    }
    let mut root = scaled
        .wrapping_shr(15)
        .wrapping_mul(21_846)
        .wrapping_shr(16)
        .wrapping_add(22_774);
    for _ in 0..2 {
        let other = scaled.checked_div(root).unwrap_or_default();
        root = root.wrapping_add(other).wrapping_shr(1);
    }
    (root.wrapping_add(2), shift.wrapping_shr(1))
}
