//! Encoder maps, learned by the product's own calibration from simulated runs of their own.

use leadscrew::encoder_map::EncoderMap;
use leadscrew_hal_mock::encoder::{Encoder, EncoderModel};
use leadscrew_hal_mock::scene::Ripple;

use super::TICK_HZ;
use super::error::AccuracyError;
use super::residue::Residue;
use crate::calibration::{Procedure, learn_simulated};

/// A learned encoder.
#[derive(Debug)]
pub struct Known {
    pub image: Vec<u8>,
    /// What the map leaves.
    pub residue: Residue,
}

/// Learns the encoder "real" of `seed` on a shaft with `ripple`.
///
/// # Errors
/// A refusal of the calibration.
pub fn learn(seed: u64, ripple: Ripple) -> Result<Known, AccuracyError> {
    let model = EncoderModel::real();
    let procedure = Procedure {
        tick_hz: TICK_HZ,
        ripple,
        ..Procedure::default()
    };
    let image = learn_simulated(&model, seed, &procedure)?;
    let encoder = Encoder::new(&model, TICK_HZ, 0.0, seed)?;
    let residue = Residue::new(&encoder, &EncoderMap::from_bytes(&image)?);
    Ok(Known { image, residue })
}
