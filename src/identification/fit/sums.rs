//! Sums over the records of a fit.

use crate::identification::drive::{PARAMETERS, Vector};
use crate::identification::matrix::Matrix;

/// Sums over records.
#[derive(Clone, Copy)]
pub struct Sums {
    pub count: f64,
    pub error: f64,
    pub slopes: Vector,
    pub products: Matrix,
    pub weighted: Vector,
    pub square: f64,
}

impl Sums {
    pub const ZERO: Self = Self {
        count: 0.0,
        error: 0.0,
        slopes: [0.0; PARAMETERS],
        products: Matrix::ZERO,
        weighted: [0.0; PARAMETERS],
        square: 0.0,
    };

    pub fn add(&mut self, error: f64, slopes: &Vector) {
        self.count += 1.0;
        self.error += error;
        self.square += error * error;
        self.products.add_product(slopes, slopes, 1.0);
        for ((sum, weighted), slope) in self.slopes.iter_mut().zip(&mut self.weighted).zip(slopes) {
            *sum += slope;
            *weighted += slope * error;
        }
    }
}

impl Sums {
    /// Products and weighted slopes about their means.
    pub fn centred(&self) -> (Matrix, Vector) {
        let count = self.count.max(1.0);
        let mut products = self.products;
        products.add_product(&self.slopes, &self.slopes, -1.0 / count);
        let mut weighted = self.weighted;
        for (sum, slope) in weighted.iter_mut().zip(&self.slopes) {
            *sum -= slope * self.error / count;
        }
        (products, weighted)
    }
}

/// Scores of clusters.
pub struct Clusters {
    pub products: Matrix,
    score: Vector,
    pub count: f64,
    is_empty: bool,
}

impl Default for Clusters {
    fn default() -> Self {
        Self {
            products: Matrix::ZERO,
            score: [0.0; PARAMETERS],
            count: 0.0,
            is_empty: true,
        }
    }
}

impl Clusters {
    pub fn add(&mut self, score: &Vector) {
        self.is_empty = false;
        for (sum, score) in self.score.iter_mut().zip(score) {
            *sum += score;
        }
    }

    pub fn end(&mut self) {
        if !self.is_empty {
            self.products.add_product(&self.score, &self.score, 1.0);
            self.count += 1.0;
        }
        self.score = [0.0; PARAMETERS];
        self.is_empty = true;
    }
}
