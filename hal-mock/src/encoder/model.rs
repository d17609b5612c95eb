//! Parameters of an encoder.

use crate::disc::DiscParams;

leadscrew::parameter_table! {
    /// What does not repeat, what depends on direction, and the capture. The default is the encoder "real".
    pub struct EncoderParams {
        /// Noise of an edge's place
        noise_d: 0.005, "d", 0.0..=0.1;
        /// Noise of an edge's time
        noise_s: 2e-8, "s", 0.0..=1e-5;
        /// How much lower an edge of A lies when it is passed backward
        hysteresis_a_d: 0.04, "d", 0.0..=0.3;
        /// How much lower an edge of B lies when it is passed backward
        hysteresis_b_d: 0.02, "d", 0.0..=0.3;
        /// Width of the index pulse
        index_width_d: 3.0, "d", 1.0..=8.0;
        /// Clock of the edge timer
        timer_hz: 84e6, "Hz", 1e6..=250e6;
        /// Jitter of the sampling instant, standard deviation
        sampling_jitter_s: 0.0, "s", 0.0..=1e-4;
    }
}

/// Systematic and other errors of an encoder together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EncoderModel {
    /// Where the edges lie.
    pub disc: DiscParams,
    /// What else there is.
    pub encoder: EncoderParams,
}

impl EncoderModel {
    /// The encoder "real" of the reference machine.
    #[must_use]
    pub fn real() -> Self {
        Self::default()
    }

    /// The encoder "ideal": edges where they belong, no noise; the timer stays.
    #[must_use]
    pub fn ideal() -> Self {
        Self {
            disc: DiscParams {
                phase_offset_d: 0.0,
                line_sigma_d: 0.0,
                edge_sigma_d: 0.0,
                eccentricity_d: 0.0,
                second_harmonic_d: 0.0,
                ..DiscParams::default()
            },
            encoder: EncoderParams {
                noise_d: 0.0,
                noise_s: 0.0,
                hysteresis_a_d: 0.0,
                hysteresis_b_d: 0.0,
                ..EncoderParams::default()
            },
        }
    }

    /// The encoder "ideal" with white noise of standard deviation `edge_noise_d` on the place of each edge:
    /// what bounds on estimators are stated for.
    #[must_use]
    pub fn white(edge_noise_d: f64) -> Self {
        let ideal = Self::ideal();
        Self {
            encoder: EncoderParams {
                noise_d: edge_noise_d,
                ..ideal.encoder
            },
            ..ideal
        }
    }

    /// The same encoder after its four phase offsets have drifted, each by up to `phase_drift_d`.
    #[must_use]
    pub fn drifted(self, phase_drift_d: f64) -> Self {
        Self {
            disc: DiscParams {
                phase_drift_d,
                ..self.disc
            },
            ..self
        }
    }
}
