//! Seeded noise, in integers.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

/// A stream of noise.
#[derive(Clone, Debug)]
pub struct Noise(Xoshiro128PlusPlus);

/// No [`Noise::bell`] is larger.
pub const LARGEST_BELL: i64 = 510;
/// σ of the sum of four uniform bytes: √(4·(2¹⁶ − 1)/12).
const BYTES_SIGMA: f64 = 147.800_54;

impl Noise {
    /// The stream `stream` of a seed; different streams are independent.
    pub fn new(seed: u64, stream: u64) -> Self {
        Self(Xoshiro128PlusPlus::seed_from_u64(
            seed ^ stream.wrapping_mul(0x9e37_79b9_7f4a_7c15),
        ))
    }

    /// Bell-shaped, bounded by ±3.45σ (the sum of four uniform bytes): |value| ≤ 510.
    pub fn bell(&mut self) -> i32 {
        let word = self.0.next_u32();
        let pairs = (word & 0x00ff_00ff) + ((word >> 8) & 0x00ff_00ff);
        ((pairs & 0xffff) + (pairs >> 16)).cast_signed() - 510
    }

    /// A bell times a scale of [`bell_scale_q32`]; a scale of zero draws nothing.
    pub fn scaled_bell(&mut self, scale: i64) -> i64 {
        if scale == 0 {
            0
        } else {
            i64::from(self.bell()) * scale
        }
    }

    /// Bell-shaped with standard deviation 1, out to ±6 (the mean of three bells).
    pub fn normal(&mut self) -> f64 {
        let sum = self.bell() + self.bell() + self.bell();
        f64::from(sum) / (BYTES_SIGMA * 1.732_050_807_568_877_2)
    }

    /// Uniform between −1 and 1.
    pub fn uniform(&mut self) -> f64 {
        f64::from(self.0.next_u32().cast_signed()) / 2_147_483_648.0
    }
}

/// Scale of [`Noise::bell`] for a standard deviation of `sigma`, in units of 2⁻³² of sigma's unit:
/// noise = bell·scale.
pub fn bell_scale_q32(sigma: f64) -> i64 {
    (sigma * 4_294_967_296.0 / BYTES_SIGMA) as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bell_and_normal_have_the_stated_deviation() {
        let mut noise = Noise::new(1, 2);
        let count = 20_000;
        let (mut bells, mut normals) = (0.0, 0.0);
        for _ in 0..count {
            let (bell, normal) = (f64::from(noise.bell()), noise.normal());
            bells += bell * bell;
            normals += normal * normal;
        }
        let bell_sigma = libm::sqrt(bells / f64::from(count));
        let normal_sigma = libm::sqrt(normals / f64::from(count));
        assert!(
            (bell_sigma / BYTES_SIGMA - 1.0).abs() < 0.02,
            "{bell_sigma}"
        );
        assert!((normal_sigma - 1.0).abs() < 0.02, "{normal_sigma}");
    }
}
