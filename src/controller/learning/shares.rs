//! A Kalman filter of the three shares, in integers.

use super::TERM_FRAC;
use crate::estimator::saturate;

/// Fractional bits of a share.
pub const SHARE_FRAC: u32 = 24;
/// Fractional bits of a covariance, and of a gain.
pub const COVARIANCE_FRAC: u32 = 30;
const GAIN_FRAC: u32 = 16;
/// Bounds of a share.
const LOWEST: i32 = -(3 << SHARE_FRAC) / 5;
const HIGHEST: i32 = 3 << (SHARE_FRAC - 1);
/// Variances of the shares at first: 0.2², 0.4², 0.6². The period, squared in the jerk's term, is the least certain.
const FIRST: [i32; 3] = [42_949_673, 171_798_692, 386_547_057];
/// What they grow by from one time to the next: (3e-4)², (6e-4)², (1e-3)²: drives change slowly.
const GROWTH: [i32; 3] = [107, 429, 966];

/// Shares of v, a and j, and how sure they are.
#[derive(Clone, Debug)]
pub struct Shares {
    values: [i32; 3],
    /// P.
    covariance: [[i32; 3]; 3],
}

impl Shares {
    /// Nothing learned.
    pub const fn new() -> Self {
        let [v, a, j] = FIRST;
        Self {
            values: [0; 3],
            covariance: [[v, 0, 0], [0, a, 0], [0, 0, j]],
        }
    }

    /// With [`SHARE_FRAC`].
    #[inline]
    pub const fn values(&self) -> &[i32; 3] {
        &self.values
    }

    /// The step of the filter for the residual `error`, with [`TERM_FRAC`], and the variance `noise` of one, with [`COVARIANCE_FRAC`].
    pub fn correct(&mut self, instrument: &[i32; 3], error: i32, noise: i32) {
        let weighed = self.covariance.map(|row| dot(&row, instrument));
        let spread = dot(&weighed, instrument);
        if spread < 0 {
            // Rounding has made a variance negative: it begins anew, with what it has learned.
            self.covariance = Self::new().covariance;
            return;
        }
        let (inverse, shift) = inverse(spread.saturating_add(noise).unsigned_abs());
        let gains = weighed.map(|weighed| {
            let gain = i64::from(weighed).wrapping_mul(i64::from(inverse));
            saturate(gain.wrapping_shr(shift))
        });
        for (share, gain) in self.values.iter_mut().zip(gains) {
            let more = i64::from(gain)
                .wrapping_mul(i64::from(error))
                .wrapping_shr(GAIN_FRAC + TERM_FRAC - SHARE_FRAC);
            *share = saturate(i64::from(*share).wrapping_add(more)).clamp(LOWEST, HIGHEST);
        }
        for (row, gain) in self.covariance.iter_mut().zip(gains) {
            for (entry, weighed) in row.iter_mut().zip(weighed) {
                let less = i64::from(gain)
                    .wrapping_mul(i64::from(weighed))
                    .wrapping_shr(GAIN_FRAC);
                *entry = saturate(i64::from(*entry).wrapping_sub(less));
            }
        }
        self.grow();
    }

    /// The variances grow, up to what they were at first.
    fn grow(&mut self) {
        let [[v, ..], [_, a, _], [.., j]] = &mut self.covariance;
        for ((variance, more), most) in [v, a, j].into_iter().zip(GROWTH).zip(FIRST) {
            *variance = variance.max(&mut 0).saturating_add(more).min(most);
        }
    }
}

/// Σ aᵢ·bᵢ of a vector and terms, in the format of the former.
fn dot(vector: &[i32; 3], terms: &[i32; 3]) -> i32 {
    let products = vector.iter().zip(terms);
    let sum = products.fold(0_i64, |sum, (a, b)| {
        sum.wrapping_add(i64::from(*a).wrapping_mul(i64::from(*b)))
    });
    saturate(sum.wrapping_shr(TERM_FRAC))
}

/// 1/`value` as a factor of a covariance and the shift that makes a gain of the product; by a 32-bit division, right to 2⁻¹⁵.
const fn inverse(value: u32) -> (u32, u32) {
    let room = if value == 0 {
        31
    } else {
        value.leading_zeros()
    };
    let coarse = value.wrapping_shl(room).wrapping_shr(16);
    let inverse = match (1_u32 << 31).checked_div(coarse) {
        Some(inverse) => inverse,
        None => 0,
    };
    // 2³⁰/value = inverse·2^(room − 17); a gain has GAIN_FRAC of that.
    (
        inverse,
        (17 + COVARIANCE_FRAC - GAIN_FRAC).wrapping_sub(room),
    )
}
