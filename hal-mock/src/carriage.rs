//! What lies between the screw and the carriage: screw error, backlash, compliance.

use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::{AxisScale, RangeError};

use crate::arc::State;
use crate::play::Play;
use crate::wave::{phase, sine};

leadscrew::parameter_table! {
    /// The carriage of the 16K20F3 on its screw.
    pub struct CarriageParams {
        /// Travel per revolution of the screw
        pitch_mm: 10.0, "mm", 0.1..=1000.0;
        /// Resonance of the carriage on the screw's compliance; 0 for a rigid one
        resonance_hz: 60.0, "Hz", 0.0..=1e4;
        /// Damping ratio of that resonance
        resonance_damping: 0.05, "1", 0.0..=2.0;
        /// Error of the screw that grows with travel
        screw_error_per_m: 0.026_667, "mm/m", -10.0..=10.0;
        /// Amplitude of the screw's error once a revolution
        screw_wobble_mm: 0.002, "mm", 0.0..=1.0;
        /// Play between screw and carriage, outside the loop
        backlash_mm: 0.0, "mm", 0.0..=1.0;
    }
}

impl CarriageParams {
    /// A carriage that is where the shaft says: rigid, without error and play.
    #[must_use]
    pub fn bare(self) -> Self {
        Self {
            resonance_hz: 0.0,
            screw_error_per_m: 0.0,
            screw_wobble_mm: 0.0,
            backlash_mm: 0.0,
            ..self
        }
    }
}

/// The carriage.
///
/// Its resonance is kept relative to the nut that drives it: there f32 is enough, and cheap.
#[derive(Clone, Debug)]
pub struct Carriage {
    turns_per_d: f64,
    slope: f64,
    wobble: f32,
    play: Play,
    resonance: Option<Resonance>,
    nut: Nut,
    swing: Swing,
}

/// Where the nut would put a rigid carriage.
#[derive(Clone, Copy, Debug, Default)]
struct Nut {
    position: f64,
    /// Gain of position in the last tick.
    velocity: f64,
}

/// The carriage less the nut in d and ticks; the acceleration is the carriage's own.
#[derive(Clone, Copy, Debug, Default)]
struct Swing {
    position: f32,
    velocity: f32,
    acceleration: f32,
}

impl Carriage {
    /// A carriage at rest where the shaft's `position` (d) puts it.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(
        params: &CarriageParams,
        scale: AxisScale,
        position: f64,
    ) -> Result<Self, RangeError> {
        params.check()?;
        let mut carriage = Self {
            turns_per_d: 1.0 / scale.counts_from_mm(params.pitch_mm),
            slope: params.screw_error_per_m / 1000.0,
            wobble: scale.counts_from_mm(params.screw_wobble_mm) as f32,
            play: Play::new(scale.counts_from_mm(params.backlash_mm), position),
            resonance: Resonance::new(params, scale.tick_hz()),
            nut: Nut::default(),
            swing: Swing::default(),
        };
        carriage.nut.position = carriage.driven_to(position);
        Ok(carriage)
    }

    /// State of the carriage, d and ticks.
    #[must_use]
    pub fn state(&self) -> State {
        State {
            position: self.nut.position + f64::from(self.swing.position),
            velocity: self.nut.velocity + f64::from(self.swing.velocity),
            acceleration: f64::from(self.swing.acceleration),
        }
    }

    /// Follows the shaft to the end of a tick.
    pub fn step(&mut self, shaft: State) {
        let position = self.driven_to(shaft.position);
        let velocity = position - self.nut.position;
        let gain = (velocity - self.nut.velocity) as f32;
        self.nut = Nut { position, velocity };
        self.swing = match &self.resonance {
            Some(resonance) => resonance.step(self.swing, gain),
            None => Swing {
                acceleration: gain,
                ..Swing::default()
            },
        };
    }

    /// Where the shaft at `shaft` puts the nut.
    fn driven_to(&mut self, shaft: f64) -> f64 {
        let (driven, _) = self.play.follow(shaft);
        let mut position = driven;
        if self.slope != 0.0 {
            position += self.slope * driven;
        }
        if self.wobble != 0.0 {
            position += f64::from(self.wobble * sine(phase(driven * self.turns_per_d)));
        }
        position
    }
}

/// The resonance, by the trapezoidal rule: x″ = ω²(d − x) + 2ζω(d′ − x′).
#[derive(Clone, Debug)]
struct Resonance {
    stiffness: f32,
    /// 2ζω.
    damping: f32,
    /// What is left of the pull, as the acceleration at the end of the tick counts in it.
    yielding: f32,
}

impl Resonance {
    fn new(params: &CarriageParams, tick_hz: f64) -> Option<Self> {
        let omega = core::f64::consts::TAU * params.resonance_hz / tick_hz;
        let (stiffness, damping) = (omega * omega, 2.0 * params.resonance_damping * omega);
        (stiffness > 0.0).then(|| Self {
            stiffness: stiffness as f32,
            damping: damping as f32,
            yielding: (1.0 / (1.0 + 0.5 * damping + 0.25 * stiffness)) as f32,
        })
    }

    /// One tick, in which the nut gains `gain` of velocity.
    fn step(&self, swing: Swing, gain: f32) -> Swing {
        let Swing {
            position,
            velocity,
            acceleration,
        } = swing;
        // What the carriage loses on the nut before its own acceleration changes.
        let behind = gain - velocity;
        let pull = self.stiffness * (behind - position - 0.25 * acceleration)
            + self.damping * (behind - 0.5 * acceleration);
        let next = pull * self.yielding;
        let mean = 0.5 * (acceleration + next);
        Swing {
            position: position - behind + 0.5 * mean,
            velocity: mean - behind,
            acceleration: next,
        }
    }
}
