//! Prescribed motions for measuring estimators: an encoder on a shaft that does just what is said.

mod course;
mod motion;
mod ripple;
mod s_curve;
mod swing;

use leadscrew::hal::{self, Capture};
use leadscrew::units::RangeError;

use crate::arc::State;
use crate::encoder::{Encoder, EncoderModel};

pub use self::motion::Motion;
pub use self::ripple::Ripple;
pub use self::s_curve::SCurve;
pub use self::swing::Swing;

use self::course::Course;
use self::ripple::Rippling;

/// An encoder on a prescribed motion.
#[derive(Clone, Debug)]
pub struct Scene {
    course: Course,
    ripple: Option<Rippling>,
    truth: State,
    encoder: Encoder,
}

impl Scene {
    /// The encoder `model`, drawn by `seed`, at `start_d` on a shaft in `motion`.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(
        motion: Motion,
        model: &EncoderModel,
        tick_hz: f64,
        start_d: f64,
        seed: u64,
    ) -> Result<Self, RangeError> {
        Self::with_ripple(motion, Ripple::NONE, model, tick_hz, start_d, seed)
    }

    /// The same with a ripple on the motion that keeps to the shaft's angle; the truth includes it.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn with_ripple(
        motion: Motion,
        ripple: Ripple,
        model: &EncoderModel,
        tick_hz: f64,
        start_d: f64,
        seed: u64,
    ) -> Result<Self, RangeError> {
        let course = Course::new(motion, start_d)?;
        let smooth = course.start();
        let ripple = Rippling::new(ripple, model.disc.edges_per_revolution, smooth)?;
        let truth = match &ripple {
            Some(ripple) => ripple.start(smooth),
            None => smooth,
        };
        Ok(Self {
            course,
            ripple,
            truth,
            encoder: Encoder::new(model, tick_hz, truth.position, seed)?,
        })
    }

    /// Moves one tick on.
    pub fn step(&mut self) {
        let mut arc = self.course.next_arc();
        if let Some(ripple) = &mut self.ripple {
            arc = ripple.bend(arc.end());
        }
        self.encoder.advance(&arc);
        self.truth = arc.at(1.0 - self.encoder.sampling_advance());
    }

    /// What the capture hardware saw in the last tick.
    #[must_use]
    pub fn capture(&self) -> Capture<'_> {
        self.encoder.capture()
    }

    /// The shaft at the last sampling instant, at its start before the first one. Where the acceleration
    /// jumps at that instant it is the one before.
    #[must_use]
    pub const fn truth(&self) -> State {
        self.truth
    }

    /// The encoder, for where its edges really lie.
    #[must_use]
    pub const fn encoder(&self) -> &Encoder {
        &self.encoder
    }
}

impl hal::Encoder for Scene {
    fn capture(&self) -> Capture<'_> {
        self.encoder.capture()
    }
}
