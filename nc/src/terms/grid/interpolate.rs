//! Multilinear interpolation, and how steep it can be.

use super::super::{Steepness, TermError, Trouble, in_range};
use super::{Grid, GridAxis, MAX_OVER};
use crate::coordinates::{AXES, Coordinates};

/// A cell along one coordinate: its lower node and how far into it, 0 to 1.
type Cell = (usize, f64);

pub(super) fn correction(grid: &Grid, at: &Coordinates) -> Result<Coordinates, TermError> {
    let mut cells = [(0, 0.0); MAX_OVER];
    for (cell, one) in cells.iter_mut().zip(&grid.over) {
        *cell = locate(one, at[one.axis]).ok_or_else(|| out_of_range(grid, one, at))?;
    }
    let width = grid.corrects.len();
    let mut sums = [0.0; AXES];
    for corner in 0..1_usize << grid.over.len() {
        let (node, weight) = corner_of(grid, &cells, corner);
        if weight != 0.0 {
            let row = &grid.values[node * width..(node + 1) * width];
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum += value * weight;
            }
        }
    }
    Ok(grid.vector(&sums[..width]))
}

fn locate(one: &GridAxis, value: f64) -> Option<Cell> {
    let (first, last) = (one.places.first()?, one.places.last()?);
    let value = in_range(value, (*first, *last))?;
    let upper = one.places.partition_point(|place| *place <= value);
    let lower = upper.min(one.places.len() - 1) - 1;
    let (a, b) = (one.places[lower], one.places[lower + 1]);
    Some((lower, (value - a) / (b - a)))
}

fn out_of_range(grid: &Grid, one: &GridAxis, at: &Coordinates) -> TermError {
    TermError {
        term: grid.name.clone(),
        trouble: Trouble::OutOfRange {
            axis: one.axis,
            value: at[one.axis],
            range: (
                one.places.first().copied().unwrap_or_default(),
                one.places.last().copied().unwrap_or_default(),
            ),
        },
    }
}

/// Node and weight of a corner of the cell; bit i of `corner` is the upper node of coordinate i.
fn corner_of(grid: &Grid, cells: &[Cell], corner: usize) -> (usize, f64) {
    let mut node = 0;
    let mut weight = 1.0;
    for (i, (one, (lower, inside))) in grid.over.iter().zip(cells).enumerate() {
        let upper = (corner >> i) & 1;
        node = node * one.places.len() + lower + upper;
        weight *= if upper == 1 { *inside } else { 1.0 - inside };
    }
    (node, weight)
}

/// Bounds over the whole grid. Within a cell ∂K/∂i does not change with i and is linear in the other coordinates, so it is largest
/// at an edge; ∂²K/∂i∂j is largest at a face, and ∂²K/∂i² is 0. Along a unit direction the sum of 2|d_i d_j| over the pairs is at
/// most one less than the number of coordinates.
pub(super) fn steepness(grid: &Grid) -> Steepness {
    let over = grid.over.len();
    let slope = (0..over)
        .map(|i| largest(grid, &[i]).powi(2))
        .sum::<f64>()
        .sqrt();
    let twist = (0..over)
        .flat_map(|i| (i + 1..over).map(move |j| [i, j]))
        .map(|pair| largest(grid, &pair))
        .fold(0.0, f64::max);
    Steepness {
        slope,
        bend: twist * over.saturating_sub(1) as f64,
    }
}

/// Of how many coordinates K is no constant.
pub(super) fn varying(grid: &Grid) -> usize {
    (0..grid.over.len())
        .filter(|i| largest(grid, &[*i]) > 0.0)
        .count()
}

/// The largest divided difference over one or two of the coordinates.
fn largest(grid: &Grid, by: &[usize]) -> f64 {
    let lengths: Vec<usize> = grid.over.iter().map(|one| one.places.len()).collect();
    let stride = |i: usize| lengths[i + 1..].iter().product::<usize>();
    let index = |node: usize, i: usize| node / stride(i) % lengths[i];
    let nodes: usize = lengths.iter().product();
    (0..nodes)
        .filter(|node| by.iter().all(|i| index(*node, *i) + 1 < lengths[*i]))
        .map(|node| {
            let run: f64 = by
                .iter()
                .map(|i| {
                    let at = index(node, *i);
                    grid.over[*i].places[at + 1] - grid.over[*i].places[at]
                })
                .product();
            let mut difference = vec![0.0; grid.corrects.len()];
            for corner in 0..1_usize << by.len() {
                let other = node
                    + by.iter()
                        .enumerate()
                        .map(|(bit, i)| ((corner >> bit) & 1) * stride(*i))
                        .sum::<usize>();
                let sign = if corner.count_ones() as usize % 2 == by.len() % 2 {
                    1.0
                } else {
                    -1.0
                };
                for (c, sum) in difference.iter_mut().enumerate() {
                    *sum += sign * grid.values[other * grid.corrects.len() + c];
                }
            }
            difference.iter().map(|d| d * d).sum::<f64>().sqrt() / run
        })
        .fold(0.0, f64::max)
}
