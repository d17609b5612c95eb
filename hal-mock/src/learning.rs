//! Runs in which an encoder's map is learned, on the host and on the target alike.

use leadscrew::calibration::{Learner, Progress, Refusal, RunPlan, RunSummary};
use leadscrew::capture::Unwrapper;
use leadscrew::units::RangeError;

use crate::encoder::EncoderModel;
use crate::scene::{Motion, Ripple, Scene};

/// Its multiples are spread evenly over a revolution.
const GOLDEN_SECTION: f64 = 0.618_034;

/// A feed of an axis that an encoder is learned from.
#[derive(Clone, Copy, Debug)]
pub struct LearningFeed<'m> {
    /// The encoder.
    pub model: &'m EncoderModel,
    /// What draws its errors and all noise.
    pub seed: u64,
    /// Number of the run. Noise is drawn an edge at a time from the start on, so each run starts elsewhere.
    pub number: u32,
    /// Control rate, Hz.
    pub tick_hz: f64,
    /// Velocity, d/tick; negative backward.
    pub velocity: f64,
    /// Revolutions to average over.
    pub revolutions: u32,
    /// The feed wobbles and drifts as that of a real axis does: [`Motion::calibration`]. Otherwise it is steady.
    pub sways: bool,
    /// What keeps to the angle of the shaft.
    pub ripple: Ripple,
}

/// Why a run could not be learned from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LearningError {
    /// A run that cannot be.
    Range(RangeError),
    /// Data that do not suffice.
    Refused(Refusal),
}

impl From<RangeError> for LearningError {
    fn from(error: RangeError) -> Self {
        Self::Range(error)
    }
}

impl From<Refusal> for LearningError {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

impl LearningFeed<'_> {
    /// Runs it and adds it to the learner's runs.
    ///
    /// # Errors
    /// A parameter out of range, or what the learner refuses.
    pub fn learn(&self, learner: &mut Learner<'_>) -> Result<RunSummary, LearningError> {
        let mut scene = self.scene()?;
        let mut unwrapper = Unwrapper::new();
        learner.begin_run(RunPlan::steady(self.revolutions))?;
        let speed = self.velocity.max(-self.velocity);
        let revolution_ticks = self.model.disc.edges_per_revolution / speed;
        // One up to the index, two for the speed, one for wobble and drift.
        for _ in 0..(f64::from(self.revolutions + 4) * revolution_ticks) as u64 {
            scene.step();
            if learner.feed(&unwrapper.unwrap(&scene.capture()))? == Progress::Complete {
                break;
            }
        }
        Ok(learner.end_run()?)
    }

    fn scene(&self) -> Result<Scene, RangeError> {
        let edges = self.model.disc.edges_per_revolution;
        let turns = GOLDEN_SECTION * f64::from(self.number);
        let start_d = (turns - f64::from(turns as u32)) * edges;
        let motion = if self.sways {
            Motion::calibration(self.velocity, edges)
        } else {
            Motion::Steady {
                velocity: self.velocity,
            }
        };
        Scene::with_ripple(
            motion,
            self.ripple,
            self.model,
            self.tick_hz,
            start_d,
            self.seed,
        )
    }
}
