//! Small symmetric systems of equations, as many as a drive has parameters.

use super::drive::{PARAMETERS, Vector};

/// A square matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix([Vector; PARAMETERS]);

impl Matrix {
    /// All zeros.
    pub const ZERO: Self = Self([[0.0; PARAMETERS]; PARAMETERS]);

    /// An element; zero outside.
    #[must_use]
    pub fn at(&self, row: usize, column: usize) -> f64 {
        let found = self.0.get(row).and_then(|row| row.get(column));
        found.copied().unwrap_or(0.0)
    }

    /// Sets an element; none outside.
    pub fn set(&mut self, row: usize, column: usize, value: f64) {
        if let Some(place) = self.0.get_mut(row).and_then(|row| row.get_mut(column)) {
            *place = value;
        }
    }

    /// Adds `scale`·a·bᵀ.
    pub fn add_product(&mut self, a: &Vector, b: &Vector, scale: f64) {
        for (row, &a) in self.0.iter_mut().zip(a) {
            for (place, &b) in row.iter_mut().zip(b) {
                *place += scale * a * b;
            }
        }
    }

    /// Adds `scale`·`other`.
    pub fn add(&mut self, other: &Self, scale: f64) {
        for (row, theirs) in self.0.iter_mut().zip(&other.0) {
            for (place, &value) in row.iter_mut().zip(theirs) {
                *place += scale * value;
            }
        }
    }

    /// The product with `other`.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        let mut product = Self::ZERO;
        for (row, own) in product.0.iter_mut().zip(&self.0) {
            for (&factor, theirs) in own.iter().zip(&other.0) {
                for (place, &value) in row.iter_mut().zip(theirs) {
                    *place += factor * value;
                }
            }
        }
        product
    }

    /// The inverse of a symmetric positive matrix, by Cholesky's factors; none if it is not positive.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        let lower = self.cholesky()?;
        let mut inverse = Self::ZERO;
        for column in 0..PARAMETERS {
            let mut unit = [0.0; PARAMETERS];
            if let Some(place) = unit.get_mut(column) {
                *place = 1.0;
            }
            let solved = lower.solve(&unit);
            for (row, value) in solved.into_iter().enumerate() {
                inverse.set(row, column, value);
            }
        }
        Some(inverse)
    }

    /// The lower factor L of L·Lᵀ.
    fn cholesky(&self) -> Option<Self> {
        let mut lower = Self::ZERO;
        for row in 0..PARAMETERS {
            for column in 0..=row {
                let known = (0..column).map(|k| lower.at(row, k) * lower.at(column, k));
                let rest = self.at(row, column) - known.sum::<f64>();
                if row == column {
                    if rest <= 1e-14 * self.at(row, row).max(1e-280) || !rest.is_finite() {
                        return None;
                    }
                    lower.set(row, row, libm::sqrt(rest));
                } else {
                    lower.set(row, column, rest / lower.at(column, column));
                }
            }
        }
        Some(lower)
    }

    /// x with L·Lᵀ·x = `right`.
    fn solve(&self, right: &Vector) -> Vector {
        let mut x = *right;
        for row in 0..PARAMETERS {
            let known: f64 = (0..row).map(|k| self.at(row, k) * part(&x, k)).sum();
            set(&mut x, row, |value| (value - known) / self.at(row, row));
        }
        for row in (0..PARAMETERS).rev() {
            let above = row.wrapping_add(1)..PARAMETERS;
            let known: f64 = above.map(|k| self.at(k, row) * part(&x, k)).sum();
            set(&mut x, row, |value| (value - known) / self.at(row, row));
        }
        x
    }

    /// The product with a vector.
    #[must_use]
    pub fn apply(&self, vector: &Vector) -> Vector {
        let mut product = [0.0; PARAMETERS];
        for (place, row) in product.iter_mut().zip(&self.0) {
            *place = row.iter().zip(vector).map(|(a, b)| a * b).sum();
        }
        product
    }
}

/// A part of a vector; zero outside.
#[must_use]
pub fn part(vector: &Vector, place: usize) -> f64 {
    vector.get(place).copied().unwrap_or(0.0)
}

/// Changes a part of a vector; none outside.
pub fn set(vector: &mut Vector, place: usize, change: impl FnOnce(f64) -> f64) {
    if let Some(value) = vector.get_mut(place) {
        *value = change(*value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_times_its_matrix_is_one() {
        let mut matrix = Matrix::ZERO;
        for k in 0..20 {
            let mut row = [0.0; PARAMETERS];
            for (i, place) in row.iter_mut().enumerate() {
                *place = libm::sin(f64::from(k) * (0.7 + 0.31 * i as f64));
            }
            matrix.add_product(&row, &row, 1.0);
        }
        let product = matrix.times(&matrix.inverse().unwrap());
        for row in 0..PARAMETERS {
            for column in 0..PARAMETERS {
                let one = f64::from(u8::from(row == column));
                assert!((product.at(row, column) - one).abs() < 1e-8);
            }
        }
        assert!(Matrix::ZERO.inverse().is_none());
    }
}
