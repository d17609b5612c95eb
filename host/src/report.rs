//! Rows that the CSV files of simulation and replay share, and the figures of an estimator.

use std::fmt;
use std::io::Write;

use comfy_table::{CellAlignment, Table, presets};
use leadscrew::capture::{CaptureHealth, MAX_DELTA};
use leadscrew::estimator::{Estimate, EstimatorConfig, Lags, Variances};
use leadscrew::units::{Lag, Variance};
use serde::Serialize;

/// Columns of every CSV, in order; further ones are only ever appended.
pub const COLUMNS: [&str; 11] = [
    "tick",
    "time_s",
    "count_d",
    "position_d",
    "velocity_d_per_tick",
    "acceleration_d_per_tick2",
    "lag_x_ticks",
    "lag_v_ticks",
    "lag_a_ticks",
    "sigma_v",
    "sigma_a",
];

/// What went wrong at the encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct CaptureFigures {
    /// Ticks in which edge times were lost.
    pub overrun_ticks: u32,
    /// Ticks in which the edge times do not explain the count; every reversal may make some.
    pub ambiguous_ticks: u32,
    /// Simultaneous changes of A and B.
    pub illegal: u32,
    /// Ticks in which the count moved further than a velocity can tell.
    pub overspeed_ticks: u32,
}

impl From<CaptureHealth> for CaptureFigures {
    fn from(health: CaptureHealth) -> Self {
        Self {
            overrun_ticks: health.overrun_ticks,
            ambiguous_ticks: health.ambiguous_ticks,
            illegal: health.illegal,
            overspeed_ticks: health.overspeed_ticks,
        }
    }
}

impl CaptureFigures {
    /// What makes the figures of a run doubtful, a line each. Ambiguous ticks do not: reversals have them.
    #[must_use]
    pub fn warnings(&self) -> String {
        let illegal = match self.illegal {
            0 => String::new(),
            count => format!("warning: {count} times A and B changed at once: counts were lost\n"),
        };
        illegal + &overrun_warning(self.overrun_ticks) + &overspeed_warning(self.overspeed_ticks)
    }
}

/// The warning of ticks with lost edge times, if there are any.
#[must_use]
pub fn overrun_warning(ticks: u32) -> String {
    match ticks {
        0 => String::new(),
        _ => format!(
            "warning: {ticks} ticks with more edges than their times fit in: raise --tick-hz\n"
        ),
    }
}

/// The warning of ticks in which the count moved too far, if there are any.
#[must_use]
pub fn overspeed_warning(ticks: u32) -> String {
    match ticks {
        0 => String::new(),
        _ => format!(
            "warning: {ticks} ticks with more than {MAX_DELTA} d: velocities are cut off there, raise --tick-hz\n"
        ),
    }
}

/// Lags of an estimator, ticks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LagFigures {
    /// Lag of the position at constant velocity.
    pub lag_x_ticks: f64,
    /// Lag of the velocity at constant acceleration.
    pub lag_v_ticks: f64,
    /// Lag of the acceleration at constant jerk.
    pub lag_a_ticks: f64,
}

impl From<&EstimatorConfig> for LagFigures {
    fn from(config: &EstimatorConfig) -> Self {
        let lags = config.lags();
        Self {
            lag_x_ticks: lags.position.to_num(),
            lag_v_ticks: lags.velocity.to_num(),
            lag_a_ticks: lags.acceleration.to_num(),
        }
    }
}

impl LagFigures {
    /// Means over estimates; none if there are none.
    #[must_use]
    pub fn mean(lags: impl Iterator<Item = Lags>) -> Option<Self> {
        let mut count = 0.0;
        let mut sums = [0.0; 3];
        for lags in lags {
            count += 1.0;
            let lags: [f64; 3] = [lags.position, lags.velocity, lags.acceleration].map(Lag::to_num);
            for (sum, lag) in sums.iter_mut().zip(lags) {
                *sum += lag;
            }
        }
        let [lag_x_ticks, lag_v_ticks, lag_a_ticks] = sums.map(|sum| sum / count);
        (count > 0.0).then_some(Self {
            lag_x_ticks,
            lag_v_ticks,
            lag_a_ticks,
        })
    }
}

impl fmt::Display for LagFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            lag_x_ticks,
            lag_v_ticks,
            lag_a_ticks,
        } = self;
        write!(f, "{lag_x_ticks:.2} {lag_v_ticks:.2} {lag_a_ticks:.2}")
    }
}

/// A table without frames: a column of names, then figures.
#[must_use]
pub fn text_table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_header(header);
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        if index > 0 {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

/// A figure with that many decimals; a dash where there is none.
#[must_use]
pub fn figure_or_dash(figure: Option<f64>, decimals: usize) -> String {
    figure.map_or_else(|| "-".to_owned(), |figure| format!("{figure:.decimals$}"))
}

/// The number with that many decimals, and no zero with a sign.
#[must_use]
pub fn decimals(value: f64, count: usize) -> String {
    let text = format!("{value:.count$}");
    let is_zero = text.chars().all(|digit| "-0.".contains(digit));
    if is_zero {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    }
}

/// Writes the shared columns of a tick, and any further ones.
pub struct CsvReport<W: Write> {
    writer: csv::Writer<W>,
    tick_hz: f64,
}

impl<W: Write> CsvReport<W> {
    /// Starts a report; `further` names the columns after the shared ones.
    ///
    /// # Errors
    /// The writer's.
    pub fn new(writer: W, tick_hz: f64, further: &[&str]) -> csv::Result<Self> {
        let mut writer = csv::Writer::from_writer(writer);
        writer.write_record(COLUMNS.iter().chain(further))?;
        Ok(Self { writer, tick_hz })
    }

    /// Writes a tick.
    ///
    /// # Errors
    /// The writer's.
    pub fn row(
        &mut self,
        tick: u64,
        count: i64,
        estimate: &Estimate,
        variances: &Variances,
        further: &[f64],
    ) -> csv::Result<()> {
        let shared = [
            estimate.position.to_num(),
            estimate.velocity.to_num(),
            estimate.acceleration.to_num(),
            estimate.lags.position.to_num(),
            estimate.lags.velocity.to_num(),
            estimate.lags.acceleration.to_num(),
            sigma(variances.velocity),
            sigma(variances.acceleration),
        ];
        self.writer.write_field(tick.to_string())?;
        self.writer
            .write_field((tick as f64 / self.tick_hz).to_string())?;
        self.writer.write_field(count.to_string())?;
        for value in shared.iter().chain(further) {
            self.writer.write_field(decimal(*value))?;
        }
        self.writer.write_record(None::<&[u8]>)
    }

    /// Ends the report.
    ///
    /// # Errors
    /// The writer's.
    pub fn finish(mut self) -> std::io::Result<()> {
        self.writer.flush()
    }
}

/// 1σ of a variance.
fn sigma(variance: Variance) -> f64 {
    variance.to_num::<f64>().sqrt()
}

/// A value to nine decimals, without zeros at the end.
fn decimal(value: f64) -> String {
    let text = format!("{value:.9}");
    match text.trim_end_matches('0').trim_end_matches('.') {
        "-0" => "0".to_owned(),
        short => short.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{CaptureFigures, decimal};

    #[test]
    fn all_that_went_wrong_is_warned_of_but_reversals() {
        let sound = CaptureFigures {
            overrun_ticks: 0,
            ambiguous_ticks: 9,
            illegal: 0,
            overspeed_ticks: 0,
        };
        assert_eq!(sound.warnings(), "");
        let faulty = CaptureFigures {
            overrun_ticks: 11,
            illegal: 12,
            overspeed_ticks: 13,
            ..sound
        };
        let warnings = faulty.warnings();
        let lines: Vec<_> = warnings.lines().collect();
        assert_eq!(lines.len(), 3, "{warnings}");
        for (line, count) in lines.iter().zip(["12 times", "11 ticks", "13 ticks"]) {
            assert!(line.starts_with(&format!("warning: {count} ")), "{line}");
        }
    }

    #[test]
    fn values_are_short_and_never_minus_zero() {
        let texts = [0.0, -0.0, -1e-12, 100.0, -1.5, 1e-9, 0.1 + 0.2].map(decimal);
        assert_eq!(texts, ["0", "0", "0", "100", "-1.5", "0.000000001", "0.3"]);
    }
}
