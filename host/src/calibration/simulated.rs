//! Learning from simulated runs.

use leadscrew::calibration::{Learner, Progress, Refusal, Requirements, RunPlan};
use leadscrew::capture::Unwrapper;
use leadscrew::encoder_map::Form;
use leadscrew::units::RangeError;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Motion, Ripple, Scene};

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
    /// The feed wobbles and drifts as that of a real axis does: [`Motion::calibration`]. Otherwise it is steady.
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
        // Noise is drawn an edge at a time from the start on: runs must not start alike.
        let start_d = (GOLDEN_SECTION * f64::from(number)).fract() * edges;
        let mut scene = procedure.scene(model, seed, velocity, start_d)?;
        learn_scene(
            &mut learner,
            &mut scene,
            procedure.revolutions,
            (edges / velocity.abs()) as u64,
        )?;
    }
    let learned = learner.finish(&procedure.requirements)?;
    Ok(image(&learned, procedure.form)?)
}

/// Its multiples are spread evenly over a revolution.
const GOLDEN_SECTION: f64 = 0.618_034;

impl Procedure {
    fn scene(
        &self,
        model: &EncoderModel,
        seed: u64,
        velocity: f64,
        start_d: f64,
    ) -> Result<Scene, RangeError> {
        let motion = if self.sways {
            Motion::calibration(velocity, model.disc.edges_per_revolution)
        } else {
            Motion::Steady { velocity }
        };
        Scene::with_ripple(motion, self.ripple, model, self.tick_hz, start_d, seed)
    }
}

/// Adds a run of `revolutions`, each of about `ticks_per_revolution`.
fn learn_scene(
    learner: &mut Learner<'_>,
    scene: &mut Scene,
    revolutions: u32,
    ticks_per_revolution: u64,
) -> Result<(), Refusal> {
    let mut unwrapper = Unwrapper::new();
    learner.begin_run(RunPlan::steady(revolutions))?;
    // One up to the index, two for the speed, one for what wobbles and drifts.
    for _ in 0..(u64::from(revolutions) + 4) * (ticks_per_revolution + 1) {
        scene.step();
        if learner.feed(&unwrapper.unwrap(&scene.capture()))? == Progress::Complete {
            break;
        }
    }
    learner.end_run().map(|_| ())
}
