//! The lathe's main spindle and its encoder: a speed that ripples, and drops where the cut begins.
//!
//! ω(t) = ω₀(t)·(1 + ripple·sin 2πft)·(1 − drop·s(t)), with s going smoothly from 0 to 1 when the tool enters the
//! workpiece and back when it leaves it. ω₀ changes at a constant rate.

use leadscrew::hal::{self, Capture};
use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::RangeError;

use crate::arc::{Arc, State};
use crate::disc::DiscParams;
use crate::encoder::{Encoder, EncoderModel, EncoderParams};
use crate::wave::{Phase, phase, sine};

leadscrew::parameter_table! {
    /// The spindle of the reference scene.
    pub struct SpindleParams {
        /// Speed; negative for backward
        rpm: 500.0, "rpm", -10000.0..=10000.0;
        /// Where it stands at first, from the index
        start_deg: 77.0, "°", 0.0..=360.0;
        /// Amplitude of the ripple of speed
        ripple: 0.01, "of the speed", 0.0..=0.5;
        /// Frequency of the ripple
        ripple_hz: 5.0, "Hz", 0.0..=100.0;
        /// Drop of speed under the cut
        drop: 0.05, "of the speed", 0.0..=0.9;
        /// Time in which the speed drops
        drop_s: 0.05, "s", 0.001..=10.0;
        /// Rate at which the speed changes to one that is set anew
        acceleration_rpm_per_s: 1000.0, "rpm/s", 1.0..=1e6;
    }
}

/// The spindle's encoder: 1 024 lines with the errors of `model`.
#[must_use]
pub fn encoder_1024(model: EncoderModel) -> EncoderModel {
    EncoderModel {
        disc: DiscParams {
            edges_per_revolution: 4096.0,
            ..model.disc
        },
        encoder: EncoderParams {
            timer_hz: 84e6,
            ..model.encoder
        },
    }
}

/// The spindle.
#[derive(Clone, Debug)]
pub struct Spindle {
    course: Course,
    speed: Speed,
    /// Position and velocity at the end of the last tick.
    end: (f64, f64),
    /// Where the encoder stands since its cable was cut.
    cut_at: Option<f64>,
    truth: State,
    encoder: Encoder,
}

/// How the speed goes on.
#[derive(Clone, Copy, Debug)]
struct Course {
    /// d/tick of one rpm, and d of a revolution.
    per_rpm: f64,
    per_turn: f64,
    /// Speed that is set, and how fast it is gone to, d/tick.
    aim: f64,
    change: f64,
    ripple: f64,
    ripple_hz: f64,
    drop: f64,
    /// Change of [`Speed::load`] a tick, to either side.
    load_step: f64,
    tick_hz: f64,
}

/// What the speed is made of.
#[derive(Clone, Copy, Debug)]
struct Speed {
    /// Without ripple and drop, d/tick.
    base: f64,
    /// How far it is under the cut, 0 to 1.
    load: f64,
    ripple: Phase,
}

impl Spindle {
    /// A spindle that already turns at its speed, with an encoder drawn by `seed`.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(
        params: &SpindleParams,
        model: &EncoderModel,
        tick_hz: f64,
        seed: u64,
    ) -> Result<Self, RangeError> {
        params.check()?;
        let per_turn = model.disc.edges_per_revolution;
        let per_rpm = per_turn / (60.0 * tick_hz);
        let start = params.start_deg / 360.0 * per_turn;
        let base = params.rpm * per_rpm;
        Ok(Self {
            encoder: Encoder::new(model, tick_hz, start, seed)?,
            course: Course {
                per_rpm,
                per_turn,
                aim: base,
                change: params.acceleration_rpm_per_s * per_rpm / tick_hz,
                ripple: params.ripple,
                ripple_hz: params.ripple_hz,
                drop: params.drop,
                load_step: -1.0 / (params.drop_s * tick_hz),
                tick_hz,
            },
            speed: Speed {
                base,
                load: 0.0,
                ripple: 0,
            },
            end: (start, base),
            cut_at: None,
            truth: State {
                position: start,
                velocity: base,
                acceleration: 0.0,
            },
        })
    }

    /// Sets another speed, to which it goes at its rate.
    pub fn set_rpm(&mut self, rpm: f64) {
        self.course.aim = rpm * self.course.per_rpm;
    }

    /// The tool enters the workpiece, or leaves it.
    pub fn load(&mut self, is_cutting: bool) {
        let step = self.course.load_step;
        let step = step.max(-step);
        self.course.load_step = if is_cutting { step } else { -step };
    }

    /// Cuts the encoder's cable: from now on no edge comes.
    pub fn cut_cable(&mut self) {
        self.cut_at.get_or_insert(self.end.0);
    }

    /// Turns through one tick.
    pub fn step(&mut self) {
        let from = self.end;
        let middle = self.course.velocity(&self.course.after(&self.speed, 0.5));
        self.speed = self.course.after(&self.speed, 1.0);
        let velocity = self.course.velocity(&self.speed);
        // Simpson's rule.
        self.end = (from.0 + (from.1 + 4.0 * middle + velocity) / 6.0, velocity);
        let arc = Arc::joining(from, self.end);
        self.truth = arc.at(1.0 - self.encoder.sampling_advance());
        let seen = match self.cut_at {
            None => arc,
            Some(position) => Arc::joining((position, 0.0), (position, 0.0)),
        };
        self.encoder.advance(&seen);
    }

    /// Its encoder, for the edges themselves.
    #[must_use]
    pub const fn encoder(&self) -> &Encoder {
        &self.encoder
    }

    /// The spindle itself at the sampling instant, d of its encoder from an index.
    #[must_use]
    pub const fn truth(&self) -> State {
        self.truth
    }

    /// Its angle from the index, revolutions without wrap.
    #[must_use]
    pub fn turns(&self) -> f64 {
        self.truth.position / self.course.per_turn
    }

    /// Speed without ripple and drop, d/tick.
    #[must_use]
    pub const fn base_velocity(&self) -> f64 {
        self.speed.base
    }
}

impl Course {
    /// The speed after a part of a tick.
    fn after(&self, speed: &Speed, part: f64) -> Speed {
        let change = self.change * part;
        Speed {
            base: speed.base + (self.aim - speed.base).clamp(-change, change),
            load: (speed.load + self.load_step * part).clamp(0.0, 1.0),
            ripple: speed
                .ripple
                .wrapping_add(phase(self.ripple_hz / self.tick_hz * part)),
        }
    }

    /// d/tick.
    fn velocity(&self, speed: &Speed) -> f64 {
        let load = speed.load * speed.load * (3.0 - 2.0 * speed.load);
        let ripple = self.ripple * f64::from(sine(speed.ripple));
        speed.base * (1.0 + ripple) * (1.0 - self.drop * load)
    }
}

impl hal::Encoder for Spindle {
    fn capture(&self) -> Capture<'_> {
        self.encoder.capture()
    }
}
