//! The reference sensor of paper P1: a tachogenerator read by an oscilloscope.
//!
//! The oscilloscope samples at 8 000 Hz with steps of 15.63 mV. The paper gives a step as 0.233 µm of
//! travel; only per tick of 1 ms does that fit (0.233 d/tick, so that 10 V is about 150 d/tick). The
//! reading is inferred so, since per sample it would be coarser than the encoder it is to judge.

use leadscrew::units::AxisScale;

use crate::arc::Arc;

/// Rate of the oscilloscope, Hz.
pub const SAMPLE_HZ: f64 = 8000.0;
/// Travel per 1 ms that one step of the oscilloscope stands for, mm.
pub const STEP_MM_PER_MS: f64 = 0.000_233;

/// Tachogenerator and oscilloscope.
#[derive(Clone, Debug)]
pub struct Tachogenerator {
    step: f64,
    ticks_per_sample: f64,
    /// Time from the start of the tick to the next sample, ticks.
    next_sample: f64,
    velocity: f64,
}

impl Tachogenerator {
    /// A tachogenerator on a shaft at rest.
    #[must_use]
    pub fn new(scale: AxisScale) -> Self {
        Self {
            step: scale.counts_from_mm(STEP_MM_PER_MS) * 1000.0 / scale.tick_hz(),
            ticks_per_sample: scale.tick_hz() / SAMPLE_HZ,
            next_sample: 0.0,
            velocity: 0.0,
        }
    }

    /// Watches the shaft through a tick; `ripple` is the relative error of the voltage.
    pub fn step(&mut self, arc: &Arc, ripple: f64) {
        let (mut sum, mut samples) = (0.0, 0.0);
        while self.next_sample < 1.0 {
            sum += self.read(arc.at(self.next_sample).velocity * (1.0 + ripple));
            samples += 1.0;
            self.next_sample += self.ticks_per_sample;
        }
        self.next_sample -= 1.0;
        if samples > 0.0 {
            self.velocity = sum / samples;
        }
    }

    /// Mean reading over the last tick, d/tick.
    #[must_use]
    pub const fn velocity(&self) -> f64 {
        self.velocity
    }

    /// One step of the oscilloscope, d/tick.
    #[must_use]
    pub const fn resolution(&self) -> f64 {
        self.step
    }

    fn read(&self, velocity: f64) -> f64 {
        let steps = velocity / self.step;
        (if steps < 0.0 {
            steps - 0.5
        } else {
            steps + 0.5
        }) as i64 as f64
            * self.step
    }
}
