//! The errors of the carriage as a table: a CSV file in mm and µm, and the points of the on-board screw table.
//!
//! ```text
//! position_mm,forward_um,backward_um
//! 0.137,2.1,-0.4
//! ```
//!
//! Errors are carriage less place, reached towards larger (forward) and smaller positions, as of the core's
//! [`ScrewPoint`]: what is written on the board is what was measured, and the compensation is its negative.

use std::fmt::Write;

use leadscrew::compensation::table::{MAX_ERROR_D, POINTS};
use leadscrew::compensation::{ScrewError, ScrewPoint, ScrewTable, Stretch};
use leadscrew::units::Position;
use leadscrew_app::store::screw;
use leadscrew_nc::source::Complaint;
use serde::Serialize;

use super::figures::Calibration;
use leadscrew_nc::csv_text::CsvText;

/// An error at a place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorPoint {
    /// The place in machine coordinates, mm.
    pub position_mm: f64,
    /// Carriage less place, µm, reached forward and backward.
    pub error_um: [f64; 2],
}

/// Errors along the axis, places growing.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ErrorTable {
    /// Its points.
    pub points: Vec<ErrorPoint>,
}

const COLUMNS: [&str; 3] = ["position_mm", "forward_um", "backward_um"];
const PLACE_MM: (f64, f64) = (-1e5, 1e5);
const ERROR_UM: (f64, f64) = (-1e5, 1e5);

impl ErrorTable {
    /// The mean errors of a calibration.
    #[must_use]
    pub fn of(calibration: &Calibration) -> Self {
        let point = |target: &super::TargetFigures| ErrorPoint {
            position_mm: target.target_mm,
            error_um: target.mean_um,
        };
        Self {
            points: calibration.targets.iter().map(point).collect(),
        }
    }

    /// Reads a CSV text.
    ///
    /// # Errors
    /// With line and column: see the module for what is expected; places that do not grow, fewer than 2 points or more than 256.
    pub fn read(text: &str) -> Result<Self, Complaint> {
        let csv = CsvText::read(text, &COLUMNS, &[])?;
        let mut table = Self::default();
        for row in csv.rows() {
            let position_mm = row.number(COLUMNS[0], PLACE_MM)?;
            if let Some(before) = table.points.last()
                && before.position_mm >= position_mm
            {
                let before = before.position_mm;
                let message = format!(
                    "position_mm = {position_mm} does not lie above the {before} before it: places are to grow"
                );
                return Err(row.complain(COLUMNS[0], message));
            }
            if table.points.len() == POINTS.1 {
                let message = format!(
                    "more than {} points: the screw table holds no more",
                    POINTS.1
                );
                return Err(row.complain(COLUMNS[0], message));
            }
            table.points.push(ErrorPoint {
                position_mm,
                error_um: [
                    row.number(COLUMNS[1], ERROR_UM)?,
                    row.number(COLUMNS[2], ERROR_UM)?,
                ],
            });
        }
        if table.points.len() < POINTS.0 {
            let (count, least) = (table.points.len(), POINTS.0);
            let message = format!("{count} points: at least {least} are needed");
            return Err(Complaint::at(text, &(text.len()..text.len()), message));
        }
        Ok(table)
    }

    /// The text of such a file.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text =
            "# Errors of the carriage: where it is less where it was told to be, at 20 °C.\n"
                .to_owned();
        text += &COLUMNS.join(",");
        text.push('\n');
        for ErrorPoint {
            position_mm,
            error_um: [forward, backward],
        } in &self.points
        {
            let _ = writeln!(text, "{position_mm},{forward:.4},{backward:.4}");
        }
        text
    }

    /// The points of the on-board table for an axis of `counts_per_mm`.
    ///
    /// # Errors
    /// A message: no resolution, a place or an error that the table does not hold, what [`ScrewTable::build`] finds wrong.
    pub fn to_screw(&self, counts_per_mm: f64) -> Result<Vec<ScrewPoint>, String> {
        if !(1e-3..=1e7).contains(&counts_per_mm) {
            return Err(format!(
                "{counts_per_mm} d/mm are no resolution: allowed 0.001 to 1e7"
            ));
        }
        let d_of_um = |um: f64| um / 1000.0 * counts_per_mm;
        for (number, point) in self.points.iter().enumerate() {
            let largest = point.error_um.map(|um| d_of_um(um).abs());
            if largest.iter().any(|error| *error > MAX_ERROR_D) {
                let place = point.position_mm;
                return Err(format!(
                    "point {number} at {place} mm: an error of {:.1} d, and the table holds up to {MAX_ERROR_D}",
                    largest[0].max(largest[1])
                ));
            }
        }
        let points: Vec<_> = self
            .points
            .iter()
            .map(|point| ScrewPoint {
                position: Position::saturating_from_num(point.position_mm * counts_per_mm),
                error: point
                    .error_um
                    .map(|um| ScrewError::saturating_from_num(d_of_um(um))),
            })
            .collect();
        let mut memory = vec![Stretch::EMPTY; points.len().saturating_sub(1)];
        ScrewTable::build(&points, &mut memory).map_err(|error| error.to_string())?;
        Ok(points)
    }

    /// The bytes that a board keeps of it: see [`Self::to_screw`].
    ///
    /// # Errors
    /// As of [`Self::to_screw`].
    pub fn to_stored(&self, counts_per_mm: f64) -> Result<Vec<u8>, String> {
        let points = self.to_screw(counts_per_mm)?;
        Ok(points.iter().flat_map(screw::to_bytes).collect())
    }

    /// The table of such bytes.
    ///
    /// # Errors
    /// A message: bytes that are no whole points.
    pub fn of_stored(bytes: &[u8], counts_per_mm: f64) -> Result<Self, String> {
        let (points, rest) = bytes.as_chunks::<{ screw::POINT }>();
        if !rest.is_empty() {
            return Err(format!(
                "{} bytes are no screw table: a point has {}",
                bytes.len(),
                screw::POINT
            ));
        }
        let points: Vec<_> = points.iter().map(screw::of_bytes).collect();
        Ok(Self::of_screw(&points, counts_per_mm))
    }

    /// The table whose on-board points are `points`.
    #[must_use]
    pub fn of_screw(points: &[ScrewPoint], counts_per_mm: f64) -> Self {
        let point = |point: &ScrewPoint| ErrorPoint {
            position_mm: point.position.to_num::<f64>() / counts_per_mm,
            error_um: point
                .error
                .map(|error| 1000.0 * error.to_num::<f64>() / counts_per_mm),
        };
        Self {
            points: points.iter().map(point).collect(),
        }
    }
}
