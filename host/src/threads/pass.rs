//! What a pass came to, by the truth.

use leadscrew::axis::Outputs;
use leadscrew::setpoint::thread::{SpindleWay, ThreadOrder};

use crate::statistics::Spread;

/// Way over which the pitch is judged, mm.
const PITCH_WAY_MM: f64 = 100.0;

/// Mean and ends of some values.
#[derive(Clone, Copy, Debug)]
struct Level {
    count: u32,
    sum: f64,
    least: f64,
    most: f64,
}

impl Default for Level {
    fn default() -> Self {
        Self {
            count: 0,
            sum: 0.0,
            least: f64::MAX,
            most: f64::MIN,
        }
    }
}

impl Level {
    fn push(&mut self, value: f64) {
        self.count += 1;
        self.sum += value;
        self.least = self.least.min(value);
        self.most = self.most.max(value);
    }

    fn mean(&self) -> f64 {
        self.sum / f64::from(self.count)
    }
}

/// What a pass came to.
#[derive(Clone, Debug)]
pub struct Pass {
    order: ThreadOrder,
    counts_per_mm: f64,
    /// Speed of the spindle when the pass was planned, rpm.
    pub rpm: f64,
    /// Errors of the full-depth part, d.
    error: Level,
    /// Following error in it, d.
    pub following: Spread,
    first_turn: Option<f64>,
    /// Of each revolution.
    turns: Vec<Level>,
}

impl Pass {
    pub(super) fn new(order: &ThreadOrder, counts_per_mm: f64, rpm: f64) -> Self {
        Self {
            order: *order,
            counts_per_mm,
            rpm,
            error: Level::default(),
            following: Spread::default(),
            first_turn: None,
            turns: Vec::new(),
        }
    }

    /// The tool is at full depth.
    pub(super) fn is_deep(&self, shaft_d: f64) -> bool {
        let position = shaft_d / self.counts_per_mm;
        let (from, to) = (self.order.from_mm, self.order.to_mm);
        (from.min(to)..=from.max(to)).contains(&position)
    }

    /// Lead with the sign of the helix, d.
    fn lead_d(&self) -> f64 {
        let lead = self.order.lead_mm * self.counts_per_mm;
        let is_left =
            (self.order.to_mm < self.order.from_mm) != (self.order.spindle == SpindleWay::Backward);
        if is_left { -lead } else { lead }
    }

    pub(super) fn push(&mut self, shaft_d: f64, turns: f64, outputs: &Outputs) {
        let lead = self.lead_d();
        let start = f64::from(self.order.start) / f64::from(self.order.starts);
        let raw = shaft_d - lead * (turns - self.order.angle_deg / 360.0 - start);
        let error = raw - lead * (raw / lead).round();
        self.error.push(error);
        self.following.push(outputs.following_error.to_num());
        let turn = (turns - *self.first_turn.get_or_insert(turns)).abs() as usize;
        if self.turns.len() <= turn {
            self.turns.resize_with(turn + 1, Level::default);
        }
        self.turns[turn].push(error);
    }

    /// Mean phase, °.
    #[must_use]
    pub fn phase_deg(&self) -> f64 {
        self.error.mean() * 360.0 / self.lead_d()
    }

    /// Largest deviation from that mean at any instant, d.
    #[must_use]
    pub fn instantaneous_d(&self) -> f64 {
        let mean = self.error.mean();
        (self.error.most - mean).max(mean - self.error.least)
    }

    /// Largest difference of a revolution's mean error from that 100 mm on, d; `None` of a shorter thread.
    #[must_use]
    pub fn pitch_error_d(&self) -> Option<f64> {
        let apart = (PITCH_WAY_MM / self.order.lead_mm).round() as usize;
        // The last revolution is not whole.
        let whole = self.turns.len().checked_sub(1)?;
        let pairs = self.turns[..whole]
            .iter()
            .zip(self.turns[..whole].get(apart..)?);
        pairs
            .map(|(near, far)| (far.mean() - near.mean()).abs())
            .reduce(f64::max)
    }
}
