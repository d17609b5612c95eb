//! The axis that the prove-out probes with.

use leadscrew_process::prove_out::{Draws, Touching};

/// Stream of the seed that the probe scatters by.
const STREAM: u64 = 41;

/// A probe that triggers with its repeatability, on an axis that latches where it stands.
pub struct ProbedAxis {
    sigma_mm: f64,
    draws: Draws,
}

impl ProbedAxis {
    /// A probe of so much repeatability, 2σ in mm.
    #[must_use]
    pub fn new(repeatability_2s_mm: f64, seed: u64) -> Self {
        Self {
            sigma_mm: 0.5 * repeatability_2s_mm,
            draws: Draws::new(seed, STREAM),
        }
    }
}

impl Touching for ProbedAxis {
    fn touch(&mut self, contact_mm: f64, _: f64) -> Result<f64, String> {
        Ok(contact_mm + self.sigma_mm * self.draws.normal())
    }

    fn sigma_mm(&self) -> f64 {
        self.sigma_mm
    }
}
