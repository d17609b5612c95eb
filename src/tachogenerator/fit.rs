//! Gain and offset, fitted tick by tick with forgetting.
//!
//! Least squares along the newest tick alone (normalised gradient): with φ = (v/V, 1) and the residual r,
//!
//! ```text
//! (gain·V, offset) += r·φ / (2^m·N)       N: the power of two at or below |φ|² = (v/V)² + 1
//! ```
//!
//! so that a tick takes between 2^−m and 2^(1−m) of its residual away. Forgetting has then a time constant of 2^(m−1)
//! to 2^m ticks of motion for the gain, of rest for the offset. V, a power of two, is a quarter or
//! so of full speed: motion tells of the gain, rest of the offset. On the
//! 16K20F3 the gain is right to 0.6 % after a move there and back (test): the last ticks of a move are slow ones.

use super::Config;
use super::config::PHI_FRAC;

/// Fractional bits of gain and offset.
const FIT_FRAC: u32 = 32;
/// Fractional bits of [`super::Gain`].
const GAIN_FRAC: u32 = 30;
/// Fractional bits of a velocity.
const VELOCITY_FRAC: u32 = 20;
/// Largest v/V: full speed is some four of it.
const MAX_PHI: i32 = 64 << PHI_FRAC;
const ONE: i64 = 1 << FIT_FRAC;

/// The fit.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    /// Q.32.
    gain: i64,
    /// d/tick, Q.32.
    offset: i64,
    /// Where the gain may lie, Q.32.
    gain_range: (i64, i64),
    /// Ticks of motion to be taken in until the gain is known.
    ticks_left: u32,
}

impl Fit {
    pub(super) const fn new(config: &Config) -> Self {
        Self {
            gain: ONE,
            offset: 0,
            gain_range: about(ONE, config.limits(false).tolerance),
            ticks_left: config.learn_ticks,
        }
    }

    pub(super) const fn is_learned(&self) -> bool {
        self.ticks_left == 0
    }

    /// Q2.30.
    pub(super) const fn gain(&self) -> i32 {
        self.gain.wrapping_shr(FIT_FRAC - GAIN_FRAC) as i32
    }

    /// Q12.20.
    pub(super) const fn offset(&self) -> i32 {
        self.offset.wrapping_shr(FIT_FRAC - VELOCITY_FRAC) as i32
    }

    /// The reading at a velocity, both Q12.20; below 2³³.
    pub(super) const fn expected(&self, velocity: i32) -> i64 {
        let product = (self.gain() as i64).wrapping_mul(velocity as i64);
        product
            .wrapping_shr(GAIN_FRAC)
            .wrapping_add(self.offset() as i64)
    }

    /// Takes a tick in whose residual lies within the band.
    pub(super) fn learn(&mut self, config: &Config, velocity: i32, residual: i32) {
        let phi = velocity
            .wrapping_shr(config.phi_shift)
            .clamp(-MAX_PHI, MAX_PHI);
        let square = i64::from(phi).wrapping_mul(i64::from(phi));
        let norm = square.wrapping_add(1 << (2 * PHI_FRAC));
        // 0 to 12.
        let norm_bits = 63_u32
            .wrapping_sub(norm.leading_zeros())
            .wrapping_sub(2 * PHI_FRAC);
        let forget = norm_bits.wrapping_add(config.forget_bits);

        let along = i64::from(residual).wrapping_mul(i64::from(phi));
        let gain_step = along.wrapping_shr(forget.wrapping_add(config.unit_bits));
        let (least, most) = self.gain_range;
        self.gain = self.gain.wrapping_add(gain_step).clamp(least, most);
        let offset_step = i64::from(residual)
            .wrapping_shl(FIT_FRAC - VELOCITY_FRAC)
            .wrapping_shr(forget);
        let most = config.most_offset;
        self.offset = self
            .offset
            .wrapping_add(offset_step)
            .clamp(most.wrapping_neg(), most);
        if phi.unsigned_abs() >= 1 << PHI_FRAC && self.ticks_left > 0 {
            self.ticks_left = self.ticks_left.wrapping_sub(1);
            if self.ticks_left == 0 {
                self.gain_range = about(self.gain, config.limits(true).tolerance);
            }
        }
    }
}

/// From `tolerance` (Q.20) below to `tolerance` above.
const fn about(gain: i64, tolerance: i64) -> (i64, i64) {
    let width = tolerance.wrapping_shl(FIT_FRAC - VELOCITY_FRAC);
    (gain.wrapping_sub(width), gain.wrapping_add(width))
}
