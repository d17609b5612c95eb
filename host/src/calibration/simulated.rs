//! Learning from simulated runs.

use leadscrew::calibration::Requirements;
use leadscrew::encoder_map::Form;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::learning::LearningFeed;
use leadscrew_hal_mock::scene::Ripple;

use super::{CalibrationError, Memory, image};

/// How simulated runs are made.
#[derive(Clone, Debug)]
pub struct Procedure {
    /// Control rate, Hz.
    pub tick_hz: f64,
    /// Speeds, d/tick; each is run forward and backward.
    pub speeds: Vec<f64>,
    /// Revolutions that each run averages over.
    pub revolutions: u32,
    /// The feed wobbles and drifts as that of a real axis does: [`leadscrew_hal_mock::scene::Motion::calibration`]. Otherwise it is steady.
    pub sways: bool,
    /// What keeps to the angle of the shaft.
    pub ripple: Ripple,
    /// What the map must satisfy.
    pub requirements: Requirements,
    /// How much the map is to know.
    pub form: Form,
}

impl Default for Procedure {
    /// Forty revolutions at 83.3 and 66.7 d/tick, both ways, on a feed that wobbles and drifts; a full map.
    fn default() -> Self {
        Self {
            tick_hz: 1000.0,
            speeds: vec![83.3, 66.7],
            revolutions: 40,
            sways: true,
            ripple: Ripple::NONE,
            requirements: Requirements::default(),
            form: Form::Full,
        }
    }
}

/// The image of the map that the product's own calibration learns of the simulated encoder `model`, drawn by
/// `seed`, from runs of its own.
///
/// # Errors
/// Runs that do not suffice, or a parameter out of range.
pub fn learn_simulated(
    model: &EncoderModel,
    seed: u64,
    procedure: &Procedure,
) -> Result<Vec<u8>, CalibrationError> {
    let edges = model.disc.edges_per_revolution;
    let mut memory = Memory::new(edges as u32);
    let mut learner = memory.learner(model.encoder.timer_hz)?;
    let both_ways = |&speed: &f64| [speed, -speed];
    for (number, velocity) in (1..).zip(procedure.speeds.iter().flat_map(both_ways)) {
        let feed = LearningFeed {
            model,
            seed,
            number,
            tick_hz: procedure.tick_hz,
            velocity,
            revolutions: procedure.revolutions,
            sways: procedure.sways,
            ripple: procedure.ripple,
        };
        feed.learn(&mut learner)?;
    }
    let learned = learner.finish(&procedure.requirements)?;
    Ok(image(&learned, procedure.form)?)
}
