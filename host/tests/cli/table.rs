//! Reads the CSV files that the command writes.

use std::path::Path;

/// Columns that simulation and replay share, as documented.
pub const SHARED: &str = "tick,time_s,count_d,position_d,velocity_d_per_tick,acceleration_d_per_tick2,\
                          lag_x_ticks,lag_v_ticks,lag_a_ticks,sigma_v,sigma_a";

/// A CSV file, all numbers.
pub struct Table {
    pub header: Vec<String>,
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    pub fn read(path: &Path) -> Self {
        let mut reader = csv::Reader::from_path(path).expect("a CSV file");
        let header = reader.headers().expect("a header");
        let header = header.iter().map(str::to_owned).collect();
        let number = |cell: &str| {
            let value: f64 = cell
                .parse()
                .unwrap_or_else(|_| panic!("{cell} is no number"));
            assert!(value.is_finite() && cell != "-0", "{cell}");
            value
        };
        let row =
            |row: csv::Result<csv::StringRecord>| row.expect("a row").iter().map(number).collect();
        let rows = reader.records().map(row).collect();
        Self { header, rows }
    }

    pub fn column(&self, name: &str) -> Vec<f64> {
        let index = self.header.iter().position(|column| column == name);
        let index = index.unwrap_or_else(|| panic!("no column {name}"));
        self.rows.iter().map(|row| row[index]).collect()
    }

    /// Asserts one row a tick, each at its time.
    #[track_caller]
    pub fn assert_ticks(&self, count: usize, tick_hz: f64) {
        assert_eq!(self.rows.len(), count);
        for (tick, row) in self.rows.iter().enumerate() {
            assert_eq!(row[..2], [tick as f64, tick as f64 / tick_hz]);
        }
    }
}
