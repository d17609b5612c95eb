//! The columns of the table: quantity, lag, and the one estimator of all rows.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::polynomial::{self, Answer};
use leadscrew::units::RangeError;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Velocity, d/tick.
    Velocity,
    /// Acceleration, d/tick².
    Acceleration,
}

/// A column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// What is measured.
    pub quantity: Quantity,
    /// Most that the estimate may lie back on average, ticks.
    pub max_lag: f64,
    /// Window, ticks.
    pub window: u32,
    /// What the fit answers for.
    pub answer: Answer,
}

/// The columns, in order.
pub const COLUMNS: [Column; 4] = [
    Column {
        quantity: Quantity::Acceleration,
        max_lag: 8.0,
        window: 15,
        answer: Answer::Centre,
    },
    Column {
        quantity: Quantity::Acceleration,
        max_lag: 4.0,
        window: 7,
        answer: Answer::Centre,
    },
    Column {
        quantity: Quantity::Velocity,
        max_lag: 4.0,
        window: 7,
        answer: Answer::Centre,
    },
    Column {
        quantity: Quantity::Velocity,
        max_lag: 1.0,
        window: 6,
        answer: Answer::Newest,
    },
];

impl Column {
    /// The name of what its fit answers for.
    #[must_use]
    pub const fn answer_name(&self) -> &'static str {
        match self.answer {
            Answer::Centre => "centre",
            Answer::Newest => "newest",
        }
    }

    /// Its estimator.
    ///
    /// # Errors
    /// Never with the values built in.
    pub fn config(&self) -> Result<EstimatorConfig, RangeError> {
        polynomial::Config::new(self.window, self.answer).map(EstimatorConfig::Polynomial)
    }
}
