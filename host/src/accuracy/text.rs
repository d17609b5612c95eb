//! The figures as text: tables for people to review.

use super::columns::{COLUMNS, Column, Quantity};
use super::figures::{Cell, Figures, RowFigures, VariantFigures};
use super::parts::Parts;
use super::variant::Variant;
use crate::report::text_table;

const HEAD: &str = "\
Estimator polynomial, every edge timed, encoder \"real\" with the map that the product's own calibration learned from
simulated runs of its own (40 revolutions at 83.3 and 66.7 d/tick both ways). 1 kHz, timer 84 MHz, d = 1/10000 revolution.
sigma = rms of estimate less truth at the estimate's own instant, bias included, settled, whole revolutions, the worst
of five encoders (seeds 1 to 5) and both directions; velocity in d/tick, acceleration in d/tick2. Window and answer
are the same in a whole column; the mean lag keeps to the column's, to a tenth of a tick. S-curve: there and back to
150 d/tick with 0.9 d/tick2, 0.01 d/tick3, standstill included; sine: +-2000 d in 400 ticks.
";

const PARTS_LEGEND: &str = "\
Where the errors come from, rms in the worst run; the squares add up to about that of the whole. Each part of a
sample's error goes through the same least-squares fit in floating point:
  white   noise of the edges' places and times, which does not repeat
  short   what the map leaves of waves shorter than 67 d, line by line
  long    what the map leaves of the harmonics of a revolution up to the 150th; in the acceleration it grows with v2
  timer   rounding of the time stamps to a clock
  fixed   what the core says less the floating-point fit of the same edges: its fixed point
  bias    the fit on the true motion less the truth: what a quadratic cannot follow
  slow    the whole error of ticks in which the window is stretched by more than 4 ticks or no edge came for as long,
          where rules for silence and rest take the place of the fit
";

const RATIOS_LEGEND: &str = "\
How many times smaller sigma is than that of other methods on the same edges: counting (differences of the count), the
papers' best (one-sided Gaussian-weighted average, sigma 6, N 25), and hostmot2's two edges (change of the count over
the time between the last edges of two ticks; its acceleration by difference), each at its own lag.
";

const STATED_LEGEND: &str = "\
The 1 sigma that estimates state: rms error over the mean of what is stated, and the share of the errors within twice
of it; all encoders and directions together. Honest is 0.80 to 1.25 and at least 90 %.
";

const BOUND_LEGEND: &str = "\
The bound on its own scene: ideal encoder with white noise of 0.005 d an edge; sigma_a over sqrt(720 sigma2/(n W^5)).
";

const LOOP_LEGEND: &str = "\
The observer in the loop, every edge timed: 300 mm there and back, S-curves included, from the index on; errors at the
sampling instant (it states no lag), the worst of five encoders. Loop and observer are tuned on the nominal drive; in the
rows with a sign its gain and natural period are other ones by so much. Loop: where its poles are placed.
";

impl Figures {
    /// All tables.
    #[must_use]
    pub fn to_text(&self) -> String {
        let fits =
            COLUMNS.map(|column| format!("{} ticks, {}", column.window, column.answer_name()));
        let mut text = format!("{HEAD}Fits of the columns: {}.\n", fits.join("; "));
        for figures in &self.variants {
            text.push_str(&format!("\n{}\n", figures.variant.title()));
            text.push_str(&figures.table());
            if figures.variant == Variant::Learned {
                text.push_str(&format!(
                    "\nMean lag, ticks, the largest of all runs\n{}",
                    figures.lags()
                ));
                text.push_str(&format!("\n{RATIOS_LEGEND}{}", figures.ratios()));
                text.push_str(&format!("\n{PARTS_LEGEND}{}", figures.parts()));
            }
        }
        text.push_str(&format!("\n{STATED_LEGEND}{}", self.stated_table()));
        text.push_str(&format!("\n{BOUND_LEGEND}{}", self.bound_table()));
        text.push_str(&format!("\n{LOOP_LEGEND}{}", self.loop_table()));
        text
    }

    fn stated_table(&self) -> String {
        let mut table = text_table(&[
            "d/tick", "window", "answer", "of v", "within", "of a", "within",
        ]);
        for stated in &self.stated {
            table.add_row([
                stated.row.to_owned(),
                stated.window.to_string(),
                if stated.newest { "newest" } else { "centre" }.to_owned(),
                format!("{:.2}", stated.honesty_v),
                format!("{:.0} %", 100.0 * stated.within_v),
                format!("{:.2}", stated.honesty_a),
                format!("{:.0} %", 100.0 * stated.within_a),
            ]);
        }
        lines(&table)
    }

    fn loop_table(&self) -> String {
        let mut table = text_table(&[
            "machine",
            "mm/min",
            "loop, rad/s",
            "sigma_v",
            "sigma_a",
            "following error, peak",
        ]);
        for row in &self.in_loop {
            let verdict = match (row.limit, row.reached()) {
                (Some(limit), Some(true)) => format!(" ok {limit}"),
                (Some(limit), _) => format!(" MISSED {limit}"),
                (None, _) => String::new(),
            };
            table.add_row([
                row.machine.to_owned(),
                row.feed_mm_per_min.to_string(),
                row.bandwidth_rad_per_s.to_string(),
                digits(row.sigma_v),
                digits(row.sigma_a) + &verdict,
                format!("{:.1}", row.following_peak),
            ]);
        }
        lines(&table)
    }

    fn bound_table(&self) -> String {
        let mut table = text_table(&["d/tick", "window", "sigma_a", "over the bound"]);
        for figure in &self.bound {
            table.add_row([
                figure.velocity.to_string(),
                figure.window.to_string(),
                digits(figure.sigma_a),
                format!("{:.3}", figure.to_bound),
            ]);
        }
        lines(&table)
    }
}

impl Variant {
    const fn title(self) -> &'static str {
        match self {
            Self::Learned => "Learned map, every edge timed; the figures to reach beside",
            Self::WithoutMap => "Without a map",
            Self::OneStamp => "Learned map, one time stamp a tick (the last edge's)",
            Self::ShaftSynchronous => {
                "With a ripple of 0.02 d twice a revolution of the shaft, in calibration and use"
            }
            Self::Drifted => "Phase offsets drifted by up to 0.02 d since the calibration",
        }
    }
}

impl VariantFigures {
    fn table(&self) -> String {
        self.of_cells(|cell| {
            let sigma = digits(cell.sigma);
            match (cell.limit, cell.reached) {
                (Some(limit), Some(true)) => format!("{sigma} ok {limit}"),
                (Some(limit), _) => format!("{sigma} MISSED {limit}"),
                (None, _) => sigma,
            }
        })
    }

    fn lags(&self) -> String {
        self.of_cells(|cell| format!("{:.2}", cell.lag_ticks))
    }

    fn ratios(&self) -> String {
        let ratio = |value: f64| match value {
            value if value < 10.0 => format!("{value:.1}"),
            value => format!("{value:.0}"),
        };
        self.of_cells(|cell| {
            let ratios = [cell.to_counting, cell.to_gaussian, cell.to_two_edge];
            ratios.map(ratio).join(" / ")
        })
    }

    /// A table of the columns.
    fn of_cells(&self, text: impl Fn(&Cell) -> String) -> String {
        let heads = COLUMNS.map(|column| column.title());
        let header: Vec<_> = std::iter::once("d/tick")
            .chain(heads.iter().map(String::as_str))
            .collect();
        let mut table = text_table(&header);
        for RowFigures { name, cells } in &self.rows {
            table.add_row(std::iter::once((*name).to_owned()).chain(cells.iter().map(&text)));
        }
        lines(&table)
    }

    fn parts(&self) -> String {
        let header = [
            "", "d/tick", "sigma", "white", "short", "long", "timer", "fixed", "bias", "slow",
        ];
        let mut table = text_table(&header);
        for (index, column) in COLUMNS.iter().enumerate() {
            for row in &self.rows {
                let cell = &row.cells[index];
                let Parts {
                    white,
                    short_wave,
                    long_wave,
                    timer,
                    fixed_point,
                    bias,
                    low_speed,
                } = cell.parts.unwrap_or_default();
                let figures = [
                    cell.sigma,
                    white,
                    short_wave,
                    long_wave,
                    timer,
                    fixed_point,
                    bias,
                    low_speed,
                ];
                let names = [column.title(), row.name.to_owned()];
                table.add_row(names.into_iter().chain(figures.map(digits)));
            }
        }
        lines(&table)
    }
}

impl Column {
    fn title(&self) -> String {
        let quantity = match self.quantity {
            Quantity::Velocity => "v",
            Quantity::Acceleration => "a",
        };
        format!("sigma_{quantity}, lag <= {}", self.max_lag)
    }
}

/// Three significant digits, and never more than six decimals.
fn digits(value: f64) -> String {
    let mut decimals = 6;
    let mut scaled = value.abs();
    while scaled >= 0.000_999_5 && decimals > 2 {
        scaled /= 10.0;
        decimals -= 1;
    }
    format!("{value:.decimals$}")
}

/// A table without blanks at the ends of its lines.
fn lines(table: &comfy_table::Table) -> String {
    table
        .lines()
        .map(|line| format!("{}\n", line.trim_end()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn figures_have_three_digits() {
        let texts = [
            0.0,
            1.234e-7,
            0.000_123_4,
            0.001_234,
            0.0567,
            0.99951,
            12.3456,
        ]
        .map(digits);
        assert_eq!(
            texts,
            [
                "0.000000", "0.000000", "0.000123", "0.00123", "0.0567", "1.00", "12.35"
            ]
        );
    }
}
