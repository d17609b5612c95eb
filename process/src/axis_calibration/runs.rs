//! What was measured: a CSV file, a line each reading.
//!
//! ```text
//! target_mm,direction,run,reading_mm,temperature_c
//! 0.137,up,1,0.1391,21.3
//! ```
//!
//! `reading_mm` is where the carriage is; `deviation_um`, instead of it, the same less the target. `temperature_c` of the
//! machine's scale is optional. Directions: up, forward or + towards larger positions; down, backward or -.

use std::fmt::Write;

use leadscrew_nc::source::Complaint;

use leadscrew_nc::csv_text::{CsvText, Row};

/// Which way a target is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Towards larger positions, ↑.
    Up,
    /// Towards smaller positions, ↓.
    Down,
}

/// A reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Where the axis was told to be, mm.
    pub target_mm: f64,
    /// Which way it came.
    pub direction: Direction,
    /// The run that it belongs to.
    pub run: u32,
    /// Where it was less where it was told to be, µm.
    pub deviation_um: f64,
    /// Temperature of the machine's scale, °C.
    pub temperature_c: Option<f64>,
}

/// All readings, in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Runs {
    /// The readings.
    pub readings: Vec<Reading>,
}

const PLACE_MM: (f64, f64) = (-1e5, 1e5);
const DEVIATION_UM: (f64, f64) = (-1e4, 1e4);
const TEMPERATURE_C: (f64, f64) = (-20.0, 80.0);
const RUN: (f64, f64) = (0.0, 1e6);

impl Direction {
    /// Both, ↑ first.
    pub const BOTH: [Self; 2] = [Self::Up, Self::Down];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Down => "down",
        }
    }

    fn read(row: &Row<'_>) -> Result<Self, Complaint> {
        let text = row.text("direction");
        match text.to_lowercase().as_str() {
            "up" | "forward" | "+" => Ok(Self::Up),
            "down" | "backward" | "-" => Ok(Self::Down),
            _ => Err(row.complain(
                "direction",
                format!("direction \"{text}\": expected up or down (forward, backward, +, -)"),
            )),
        }
    }
}

impl Runs {
    /// Reads a CSV text.
    ///
    /// # Errors
    /// With line and column: see the module for what is expected; a reading that is there twice.
    pub fn read(text: &str) -> Result<Self, Complaint> {
        let needed = ["target_mm", "direction", "run"];
        let optional = ["reading_mm", "deviation_um", "temperature_c"];
        let csv = CsvText::read(text, &needed, &optional)?;
        if csv.has("reading_mm") == csv.has("deviation_um") {
            return Err(
                csv.complain_of_header("expected one of the columns reading_mm and deviation_um")
            );
        }
        let mut runs = Self::default();
        for row in csv.rows() {
            let reading = reading(&row, csv.has("reading_mm"), csv.has("temperature_c"))?;
            let is_same = |known: &&Reading| {
                known.target_mm == reading.target_mm
                    && known.direction == reading.direction
                    && known.run == reading.run
            };
            if runs.readings.iter().any(|known| is_same(&known)) {
                let message = format!(
                    "target {} mm, {}, run {} is there twice: number the runs",
                    reading.target_mm,
                    reading.direction.name(),
                    reading.run
                );
                return Err(row.complain("run", message));
            }
            runs.readings.push(reading);
        }
        Ok(runs)
    }

    /// The text of such a file, with deviations.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let has_temperature = self
            .readings
            .iter()
            .any(|reading| reading.temperature_c.is_some());
        let mut text = "target_mm,direction,run,deviation_um".to_owned();
        text += if has_temperature {
            ",temperature_c\n"
        } else {
            "\n"
        };
        for reading in &self.readings {
            let Reading {
                target_mm,
                direction,
                run,
                deviation_um,
                temperature_c,
            } = reading;
            let _ = write!(
                text,
                "{target_mm},{},{run},{deviation_um}",
                direction.name()
            );
            if has_temperature {
                let _ = write!(
                    text,
                    ",{}",
                    temperature_c.map_or_else(String::new, |celsius| celsius.to_string())
                );
            }
            text.push('\n');
        }
        text
    }
}

fn reading(row: &Row<'_>, is_place: bool, has_temperature: bool) -> Result<Reading, Complaint> {
    let target_mm = row.number("target_mm", PLACE_MM)?;
    let deviation_um = if is_place {
        let deviation = 1000.0 * (row.number("reading_mm", PLACE_MM)? - target_mm);
        if !(DEVIATION_UM.0..=DEVIATION_UM.1).contains(&deviation) {
            let message = format!(
                "the reading is {:.3} mm off its target: allowed 10 mm",
                deviation / 1000.0
            );
            return Err(row.complain("reading_mm", message));
        }
        deviation
    } else {
        row.number("deviation_um", DEVIATION_UM)?
    };
    let run = row.number("run", RUN)?;
    if run.fract() != 0.0 {
        return Err(row.complain("run", format!("run {run}: expected a whole number")));
    }
    // A thermometer is not always read.
    let temperature_c = (has_temperature && !row.text("temperature_c").is_empty())
        .then(|| row.number("temperature_c", TEMPERATURE_C))
        .transpose()?;
    Ok(Reading {
        target_mm,
        direction: Direction::read(row)?,
        run: run as u32,
        deviation_um,
        temperature_c,
    })
}
