//! What the runs of a row come to.

use leadscrew::estimator::polynomial::Answer;
use serde::Serialize;

use super::bound::BoundFigure;
use super::columns::{COLUMNS, Column, Quantity};
use super::in_loop::LoopRow;
use super::methods::{COUNTING, FITS, GAUSSIAN, fit_of};
use super::parts::Parts;
use super::rows::Row;
use super::run::{RunFigures, Tallies};
use super::tally::Tally;
use super::variant::Variant;

/// A figure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// Of the worst encoder and direction, d/tick or d/tick².
    pub sigma: f64,
    /// What is to be reached.
    pub limit: Option<f64>,
    /// The limit is kept, and so is the column's lag, to a tenth of a tick.
    pub reached: Option<bool>,
    /// Mean lag, the largest of all runs, ticks.
    pub lag_ticks: f64,
    /// σ of plain counting over this one.
    pub to_counting: f64,
    /// σ of the Gaussian-weighted average over this one.
    pub to_gaussian: f64,
    /// σ of hostmot2's method over this one.
    pub to_two_edge: f64,
    /// Where it comes from, in the worst run.
    pub parts: Option<Parts>,
}

/// A row's figures, in the order of the columns.
#[derive(Clone, Debug, Serialize)]
pub struct RowFigures {
    /// The row.
    pub name: &'static str,
    /// Its figures.
    pub cells: Vec<Cell>,
}

/// The figures of a variant.
#[derive(Clone, Debug, Serialize)]
pub struct VariantFigures {
    /// Which one.
    pub variant: Variant,
    /// Its rows.
    pub rows: Vec<RowFigures>,
}

/// How the 1σ that an estimator states compares with its errors, all encoders and directions together.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Stated {
    /// The row.
    pub row: &'static str,
    /// Window, ticks.
    pub window: u32,
    /// True where it answers for the newest sample.
    pub newest: bool,
    /// Rms error of the velocity over the mean of what is stated.
    pub honesty_v: f64,
    /// Share of the velocity's errors within 2σ.
    pub within_v: f64,
    /// The same of the acceleration.
    pub honesty_a: f64,
    /// The same of the acceleration.
    pub within_a: f64,
}

/// All figures.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// The main table first.
    pub variants: Vec<VariantFigures>,
    /// What is stated of the uncertainty, with the learned map.
    pub stated: Vec<Stated>,
    /// The bound on its own scene.
    pub bound: Vec<BoundFigure>,
    /// The observer in the loop.
    pub in_loop: Vec<LoopRow>,
}

impl Tallies {
    const fn of(&self, quantity: Quantity) -> &Tally {
        match quantity {
            Quantity::Velocity => &self.velocity,
            Quantity::Acceleration => &self.acceleration,
        }
    }
}

impl RowFigures {
    /// Of all runs of a row.
    pub(super) fn new(variant: Variant, row: &Row, runs: &[RunFigures]) -> Self {
        let cell = |(index, column): (usize, &Column)| {
            let limit = match variant {
                Variant::Learned => row.limits[index],
                _ => None,
            };
            let mut cell = Cell::of(column, runs);
            cell.set_limit(limit, column.max_lag);
            if variant == Variant::Learned {
                let worst = worst(runs, |run| run.fit(column).error.rms());
                cell.parts = worst.and_then(|run| run.parts.get(index).copied());
            }
            cell
        };
        Self {
            name: row.name,
            cells: COLUMNS.iter().enumerate().map(cell).collect(),
        }
    }
}

impl RunFigures {
    /// What a column's estimator did.
    fn fit(&self, column: &Column) -> &Tally {
        self.estimators[fit_of(column)].of(column.quantity)
    }
}

impl Cell {
    fn of(column: &Column, runs: &[RunFigures]) -> Self {
        let largest = |of: &dyn Fn(&RunFigures) -> f64| runs.iter().map(of).fold(0.0, f64::max);
        let sigma = largest(&|run| run.fit(column).error.rms());
        let of_method = |index: usize| {
            largest(&|run| run.estimators[index].of(column.quantity).error.rms()) / sigma
        };
        Self {
            sigma,
            limit: None,
            reached: None,
            lag_ticks: largest(&|run| run.fit(column).mean_lag()),
            to_counting: of_method(COUNTING),
            to_gaussian: of_method(GAUSSIAN),
            to_two_edge: largest(&|run| run.two_edge.of(column.quantity).error.rms()) / sigma,
            parts: None,
        }
    }

    fn set_limit(&mut self, limit: Option<f64>, max_lag: f64) {
        self.limit = limit;
        let in_time = self.lag_ticks < max_lag + 0.05;
        self.reached = limit.map(|limit| self.sigma <= limit && in_time);
    }
}

fn worst(runs: &[RunFigures], of: impl Fn(&RunFigures) -> f64) -> Option<&RunFigures> {
    runs.iter()
        .max_by(|one, other| of(one).total_cmp(&of(other)))
}

impl Stated {
    /// Of all fits on a row.
    pub(super) fn of(row: &Row, runs: &[RunFigures]) -> Vec<Self> {
        let of_fit = |(index, (window, answer)): (usize, &(u32, Answer))| {
            let all = |quantity| {
                runs.iter().fold(Tally::default(), |sum, run| {
                    sum.and(run.estimators[index].of(quantity))
                })
            };
            let (velocity, acceleration) = (all(Quantity::Velocity), all(Quantity::Acceleration));
            Self {
                row: row.name,
                window: *window,
                newest: *answer == Answer::Newest,
                honesty_v: velocity.honesty(),
                within_v: velocity.within_two_sigma(),
                honesty_a: acceleration.honesty(),
                within_a: acceleration.within_two_sigma(),
            }
        };
        FITS.iter().enumerate().map(of_fit).collect()
    }
}
