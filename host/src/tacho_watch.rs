//! The core's cross-check of the encoder by the tachogenerator, over a run.

use leadscrew::estimator::Estimate;
use leadscrew::tachogenerator::{Config, CrossCheck, Disagreement, TachogeneratorParams};
use leadscrew::units::{AxisScale, RangeError, Velocity};
use leadscrew_hal_mock::machine::MachineParams;

use crate::statistics::Spread;

/// The check while the run goes on.
pub struct TachoWatch {
    check: CrossCheck,
    tick: u32,
    watched: Watched,
}

/// What it came to.
#[derive(Clone, Debug, Default)]
pub struct Watched {
    /// Fitted gain, tachogenerator over encoder.
    pub gain: f64,
    /// Fitted offset, d/tick.
    pub offset: f64,
    /// True if the axis moved for long enough to know the gain.
    pub is_learned: bool,
    /// What the readings were off the fit, d/tick.
    pub residual: Spread,
    /// The disagreement at the end.
    pub disagreement: Option<Disagreement>,
    /// The last kind of disagreement there was.
    pub last: Option<Disagreement>,
    /// First tick of a disagreement.
    pub first_tick: Option<u32>,
    /// Times that one began.
    pub disagreements: u32,
}

impl TachoWatch {
    /// A watch over the axis of `machine`; readings are `reading_age` ticks old on average.
    ///
    /// # Errors
    /// An axis on which the check's defaults are out of range.
    pub fn new(
        machine: &MachineParams,
        tick_hz: f64,
        reading_age: f64,
    ) -> Result<Self, RangeError> {
        let scale = AxisScale::new(machine.mount.counts_per_mm, tick_hz)?;
        let params = TachogeneratorParams {
            full_feed_mm_per_min: machine.drive.full_command_feed_mm_per_min,
            reading_age_ticks: reading_age,
            ..TachogeneratorParams::default()
        };
        Ok(Self {
            check: CrossCheck::new(Config::new(&params, scale)?),
            tick: 0,
            watched: Watched::default(),
        })
    }

    /// Takes the encoder's estimate and the reading of a tick.
    pub fn note(&mut self, estimate: &Estimate, reading: f64) {
        let reading = Velocity::saturating_from_num(reading);
        let found = self
            .check
            .update(estimate.velocity, estimate.lags.velocity, reading);
        if let Some(found) = found {
            self.watched.last = Some(found);
            self.watched.first_tick.get_or_insert(self.tick);
        }
        self.watched.residual.push(self.check.residual().to_num());
        self.tick += 1;
    }

    /// What it came to.
    #[must_use]
    pub fn finish(self) -> Watched {
        Watched {
            gain: self.check.gain().to_num(),
            offset: self.check.offset().to_num(),
            is_learned: self.check.is_learned(),
            disagreement: self.check.disagreement(),
            disagreements: self.check.health().disagreements,
            ..self.watched
        }
    }
}

impl Watched {
    /// The warning of a disagreement, a line; empty if there was none.
    #[must_use]
    pub fn warning(&self) -> String {
        let (Some(tick), Some(last)) = (self.first_tick, self.last) else {
            return String::new();
        };
        let words = describe(last).1;
        format!("warning: encoder and tachogenerator disagree from tick {tick} on: {words}\n")
    }
}

/// A disagreement in a word for programs, and in words.
#[must_use]
pub const fn describe(disagreement: Disagreement) -> (&'static str, &'static str) {
    match disagreement {
        Disagreement::Broken => (
            "broken",
            "the motor turns, the encoder stands: check the coupling and the encoder's supply",
        ),
        Disagreement::Slipping => (
            "slipping",
            "the encoder turns less than the motor: check the coupling, and for lost counts",
        ),
        Disagreement::Reversed => (
            "reversed",
            "they turn in opposite directions: swap A and B or the tachogenerator's wires",
        ),
        Disagreement::Dead => (
            "dead",
            "the encoder turns, the tachogenerator stands: check its brushes and wires",
        ),
        Disagreement::Weak => (
            "weak",
            "the tachogenerator turns less than the encoder: check its scale, and the encoder for false edges",
        ),
    }
}
