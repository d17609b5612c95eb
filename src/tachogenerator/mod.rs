//! Cross-check of the encoder by a tachogenerator on the motor: does what is measured move with what moves?
//!
//! ```text
//! reading = gain·velocity + offset + residual         each at the same instant
//! ```
//!
//! A tick takes the encoder's velocity with its lag and a reading, and compares the velocity of the tick before
//! with what the tachogenerator said at that velocity's own instant (`readings.rs`). Gain and offset are fitted
//! recursively, with forgetting and without a division (`fit.rs`).
//!
//! **Disagreement.** What of the residual (from the fit, once it is learned) lies outside the band, floor + tolerance·speed, is added up, apart for
//! either sign; the sum falls by the band while the two agree, to zero. It is a distance: when it passes the set one,
//! the check disagrees and says how ([`Disagreement`], by the motion of the last 16 ticks or so: it is refined
//! while the encoder's filter runs out). Where the encoder loses the share s of the speed v, that is after at most
//!
//! ```text
//! distance / ((s − tolerance)·v − floor) + lag + settling of the estimator + 2      ticks
//! ```
//!
//! and as far as the axis goes at v in that time. Below floor/(s − tolerance) nothing is seen: with the defaults
//! a broken coupling above 26 mm/min. Until the gain is learned, the reading has to be within the start's
//! tolerance and floor of the velocity itself.
//! The check agrees again after a set time of motion within the band.
//!
//! **What the fit may take for the truth.** It learns only from ticks that agree. Once it has learned, it stays
//! within the tolerance about what it then was, so that a slip that grows slowly is seen when it comes to twice the
//! tolerance; a smaller one shows in the gain alone. Offset and gain are told apart by rest or by motion in
//! both directions.

pub mod config;
mod fit;
mod readings;

pub use config::{Config, ReadingScale, TachogeneratorParams};

use self::fit::Fit;
use self::readings::Readings;
use crate::estimator::saturate;
use crate::units::{Lag, Velocity};

/// Gain of the readings: tachogenerator's velocity over the encoder's.
pub type Gain = fixed::types::I2F30;

/// Velocities are kept within this, so that their differences fit: ±2 047 d/tick.
const MAX_VELOCITY: i32 = 2047 << 20;
/// Ticks over which the kind of a disagreement is judged: 2⁴.
const KIND_BITS: u32 = 4;
/// An eighth of the other's motion is standing still.
const STILL_BITS: u32 = 3;

/// How the two disagree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Disagreement {
    /// The tachogenerator turns, the encoder stands: the coupling is broken, or the encoder dead.
    Broken,
    /// The encoder turns less than the tachogenerator: the coupling slips, or counts are lost.
    Slipping,
    /// They turn in opposite directions: one of them is wired the wrong way.
    Reversed,
    /// The encoder turns, the tachogenerator stands: it is dead or not connected.
    Dead,
    /// The tachogenerator turns less than the encoder: it is weak, or false edges are counted.
    Weak,
}

/// Totals since the start; they stop at their maximum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CrossCheckHealth {
    /// Times that a disagreement began.
    pub disagreements: u32,
}

/// The check.
#[derive(Clone, Debug)]
pub struct CrossCheck {
    config: Config,
    readings: Readings,
    /// Velocity and lag of the tick before.
    earlier: Option<(i32, Lag)>,
    fit: Fit,
    /// Residual of the last comparison, Q12.20 d/tick.
    residual: i32,
    /// What lies above and below the band added up, Q.20 d.
    beyond: [i64; 2],
    /// Motion by encoder and tachogenerator while something lies beyond, forgetting; Q.20.
    moved: [i64; 2],
    disagreement: Option<Disagreement>,
    /// Ticks of motion within the band since the last one outside it.
    agreeing: u32,
    health: CrossCheckHealth,
}

impl CrossCheck {
    /// A check that has seen nothing.
    #[must_use]
    pub fn new(config: Config) -> Self {
        Self {
            fit: Fit::new(&config),
            config,
            readings: Readings::new(),
            earlier: None,
            residual: 0,
            beyond: [0; 2],
            moved: [0; 2],
            disagreement: None,
            agreeing: 0,
            health: CrossCheckHealth { disagreements: 0 },
        }
    }

    /// Forgets the fit and any disagreement, as after a repair; the totals stay. Outside the tick.
    pub fn restart(&mut self) {
        *self = Self {
            health: self.health,
            ..Self::new(self.config)
        };
    }

    /// Takes the encoder's velocity with its lag and the tachogenerator's reading, once a tick. A lag of more than
    /// 61 ticks cannot be compared.
    pub fn update(
        &mut self,
        velocity: Velocity,
        lag: Lag,
        reading: Velocity,
    ) -> Option<Disagreement> {
        self.readings.push(within(reading));
        if let Some((earlier, lag)) = self.earlier.replace((within(velocity), lag)) {
            let age = Lag::ONE
                .wrapping_add(lag)
                .wrapping_sub(self.config.reading_age);
            if let Some(reading) = self.readings.before(age) {
                self.compare(earlier, reading);
            }
        }
        self.disagreement
    }

    /// The disagreement there is.
    #[must_use]
    pub const fn disagreement(&self) -> Option<Disagreement> {
        self.disagreement
    }

    /// The fitted gain.
    #[must_use]
    pub fn gain(&self) -> Gain {
        Gain::from_bits(self.fit.gain())
    }

    /// The fitted offset of the readings, d/tick.
    #[must_use]
    pub fn offset(&self) -> Velocity {
        Velocity::from_bits(self.fit.offset())
    }

    /// True once the axis has moved for long enough to know the gain.
    #[must_use]
    pub const fn is_learned(&self) -> bool {
        self.fit.is_learned()
    }

    /// What the last reading was off the fit, d/tick; saturates.
    #[must_use]
    pub const fn residual(&self) -> Velocity {
        Velocity::from_bits(self.residual)
    }

    /// What happened so far.
    #[must_use]
    pub const fn health(&self) -> CrossCheckHealth {
        self.health
    }

    /// Both Q12.20 d/tick and within [`MAX_VELOCITY`].
    fn compare(&mut self, velocity: i32, reading: i32) {
        let off_fit = i64::from(reading).wrapping_sub(self.fit.expected(velocity));
        self.residual = saturate(off_fit);
        // A fit that is being found would follow the fault.
        let residual = if self.fit.is_learned() {
            off_fit
        } else {
            i64::from(reading).wrapping_sub(i64::from(velocity))
        };
        let speed = velocity.unsigned_abs().max(reading.unsigned_abs());
        let limits = self.config.limits(self.fit.is_learned());
        let band = limits.band(speed);
        let cap = self.config.distance.wrapping_mul(2);
        let [above, below] = self.beyond;
        // A residual is below 2³⁴ and the sums are capped: nothing here wraps.
        let beyond = [
            above
                .wrapping_add(residual)
                .wrapping_sub(band)
                .clamp(0, cap),
            below
                .wrapping_sub(residual)
                .wrapping_sub(band)
                .clamp(0, cap),
        ];
        self.beyond = beyond;
        self.note_motion(velocity, reading);
        if beyond.into_iter().any(|sum| sum > self.config.distance) {
            self.raise();
        }
        let is_within = residual.wrapping_abs() <= band;
        if self.disagreement.is_some() {
            self.settle(is_within, i64::from(speed) > limits.floor.wrapping_mul(2));
        } else if is_within && beyond == [0, 0] {
            self.fit.learn(&self.config, velocity, self.residual);
        }
    }

    /// Motion since the two began to differ.
    fn note_motion(&mut self, velocity: i32, reading: i32) {
        if self.beyond == [0, 0] && self.disagreement.is_none() {
            self.moved = [0; 2];
            return;
        }
        let offset = i64::from(self.fit.offset());
        let turned = [i64::from(velocity), i64::from(reading).wrapping_sub(offset)];
        for (moved, turned) in self.moved.iter_mut().zip(turned) {
            let forgotten = moved.wrapping_shr(KIND_BITS);
            *moved = moved.wrapping_sub(forgotten).wrapping_add(turned);
        }
    }

    fn raise(&mut self) {
        if self.disagreement.is_none() {
            self.health.disagreements = self.health.disagreements.saturating_add(1);
        }
        self.disagreement = Some(kind(self.moved));
        self.agreeing = 0;
    }

    /// A disagreement ends after a time of motion within the band; standing still tells nothing.
    const fn settle(&mut self, is_within: bool, is_moving: bool) {
        if !is_within {
            self.agreeing = 0;
        } else if is_moving {
            self.agreeing = self.agreeing.wrapping_add(1);
            if self.agreeing >= self.config.clear_ticks {
                self.disagreement = None;
                self.agreeing = 0;
                self.beyond = [0; 2];
            }
        }
    }
}

/// What motion of encoder and tachogenerator comes to.
const fn kind([encoder, tachogenerator]: [i64; 2]) -> Disagreement {
    let (by_encoder, by_tachogenerator) = (encoder.unsigned_abs(), tachogenerator.unsigned_abs());
    if by_encoder <= by_tachogenerator.wrapping_shr(STILL_BITS) {
        Disagreement::Broken
    } else if by_tachogenerator <= by_encoder.wrapping_shr(STILL_BITS) {
        Disagreement::Dead
    } else if encoder.is_negative() != tachogenerator.is_negative() {
        Disagreement::Reversed
    } else if by_encoder < by_tachogenerator {
        Disagreement::Slipping
    } else {
        Disagreement::Weak
    }
}

/// Within ±[`MAX_VELOCITY`].
fn within(velocity: Velocity) -> i32 {
    velocity.to_bits().clamp(-MAX_VELOCITY, MAX_VELOCITY)
}
