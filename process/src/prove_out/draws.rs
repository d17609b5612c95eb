//! Seeded noise.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Numbers drawn one after the other, the same for the same seed.
#[derive(Clone, Debug)]
pub struct Draws(Xoshiro256PlusPlus);

impl Draws {
    /// The stream `stream` of a seed; different streams are independent.
    #[must_use]
    pub fn new(seed: u64, stream: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(
            seed ^ stream.wrapping_mul(0x9e37_79b9_7f4a_7c15),
        ))
    }

    /// Uniform from 0 to 1.
    pub fn uniform(&mut self) -> f64 {
        // The upper 53 bits: as many as an f64 has.
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Bell-shaped with mean 0 and standard deviation 1, out to ±6: the sum of twelve uniform ones.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}
