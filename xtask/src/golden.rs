//! The golden table of instruction counts: a text file that people review.

use std::collections::BTreeMap;

use crate::Result;

const HEAD: &str = "\
# Instructions of every stage on a Cortex-M4F, counted by QEMU (they are not cycles), over the moving
# ticks of the standard move; `adversary` over random inputs that no machine gives. `step` is the whole
# tick with that estimator; `product` is the core alone, in bytes.
# Written by `cargo xtask bench --bless`; `cargo xtask bench` fails on a change of more than 2 %
# (and of more than 4 instructions, which the compiler's registers may take).
";

/// Median and worst of every stage.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table(Vec<Row>);

#[derive(Clone, Debug, PartialEq, Eq)]
struct Row {
    stage: String,
    counts: Counts,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Counts {
    median: u32,
    worst: u32,
}

impl Table {
    /// Reads the lines `bench <stage> <median> <worst> <samples>` of the guest's log, others apart.
    pub fn from_log(log: &str) -> Result<Self> {
        let lines = log.lines().filter_map(|line| line.strip_prefix("bench "));
        let table = Self::from_lines(lines, "log")?;
        if table.0.is_empty() {
            return Err("the bench logged no stage".to_owned());
        }
        Ok(table)
    }

    /// Reads a golden file.
    pub fn from_file(text: &str) -> Result<Self> {
        let lines = text.lines().filter(|line| {
            let line = line.trim_start();
            !line.is_empty() && !line.starts_with('#') && !line.starts_with("stage ")
        });
        Self::from_lines(lines, "golden file")
    }

    fn from_lines<'a>(lines: impl Iterator<Item = &'a str>, source: &str) -> Result<Self> {
        let rows = lines.map(|line| {
            row(line).ok_or_else(|| {
                format!("{source}: expected a stage and its median and worst count, got `{line}`")
            })
        });
        rows.collect::<Result<_>>().map(Self)
    }

    /// The golden file's text.
    pub fn to_text(&self) -> String {
        let widest = self.0.iter().map(|row| row.stage.len()).max().unwrap_or(0);
        let width = widest.max("stage".len());
        let mut text = format!("{HEAD}{:width$}   median    worst\n", "stage");
        for row in &self.0 {
            let Counts { median, worst } = row.counts;
            text.push_str(&format!("{:width$} {median:>8} {worst:>8}\n", row.stage));
        }
        text
    }

    /// What is to be explained before `self` may take the place of `golden`; empty if nothing is.
    pub fn differences(&self, golden: &Self) -> Vec<String> {
        let old = golden.by_stage();
        let new = self.by_stage();
        let mut differences = Vec::new();
        for (stage, counts) in &new {
            match old.get(stage) {
                None => differences.push(format!("{stage}: not in the golden table")),
                Some(old) => {
                    differences.extend(change(stage, "median", old.median, counts.median));
                    differences.extend(change(stage, "worst", old.worst, counts.worst));
                }
            }
        }
        let gone = old.keys().filter(|stage| !new.contains_key(*stage));
        differences.extend(gone.map(|stage| format!("{stage}: no longer measured")));
        differences
    }

    fn by_stage(&self) -> BTreeMap<&str, Counts> {
        self.0
            .iter()
            .map(|row| (row.stage.as_str(), row.counts))
            .collect()
    }
}

fn row(line: &str) -> Option<Row> {
    let mut words = line.split_whitespace();
    Some(Row {
        stage: words.next()?.to_owned(),
        counts: Counts {
            median: words.next()?.parse().ok()?,
            worst: words.next()?.parse().ok()?,
        },
    })
}

/// Instructions by which a stage may change with the compiler's choice of registers alone.
const REGISTERS: u32 = 4;
/// Below this a count stands for a few instructions each of which matters, as that of an edge.
const SMALL: u32 = 20;

fn change(stage: &str, what: &str, old: u32, new: u32) -> Option<String> {
    let by = old.abs_diff(new);
    let is_small = u64::from(by) * 50 <= u64::from(old) || (by <= REGISTERS && old >= SMALL);
    let percent = (f64::from(new) / f64::from(old.max(1)) - 1.0) * 100.0;
    (!is_small).then(|| format!("{stage}: {what} {old} -> {new} ({percent:+.1} %)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: &[(&str, u32, u32)]) -> Table {
        let rows = rows.iter().map(|&(stage, median, worst)| Row {
            stage: stage.to_owned(),
            counts: Counts { median, worst },
        });
        Table(rows.collect())
    }

    #[test]
    fn a_change_within_two_percent_is_none() {
        let golden = table(&[("step", 300, 350)]);
        assert!(table(&[("step", 306, 343)]).differences(&golden).is_empty());
        assert_eq!(
            table(&[("step", 307, 342)]).differences(&golden),
            [
                "step: median 300 -> 307 (+2.3 %)",
                "step: worst 350 -> 342 (-2.3 %)"
            ]
        );
    }

    #[test]
    fn any_change_of_a_small_count_is_one() {
        let golden = table(&[("mul", 3, 3), ("empty", 0, 0)]);
        assert!(golden.differences(&golden).is_empty());
        let new = table(&[("mul", 4, 3), ("empty", 0, 1)]);
        assert_eq!(new.differences(&golden).len(), 2);
    }

    #[test]
    fn a_few_instructions_of_a_short_stage_are_none() {
        let golden = table(&[("unwrap", 48, 48)]);
        assert!(table(&[("unwrap", 52, 44)]).differences(&golden).is_empty());
        assert_eq!(table(&[("unwrap", 53, 43)]).differences(&golden).len(), 2);
    }

    #[test]
    fn stages_that_come_or_go_are_told() {
        let golden = table(&[("old", 1, 1)]);
        assert_eq!(
            table(&[("new", 1, 1)]).differences(&golden),
            ["new: not in the golden table", "old: no longer measured"]
        );
    }

    #[test]
    fn the_file_reads_back_as_it_was_written() {
        let table = table(&[("estimator/exponential", 44, 51), ("step", 12_345, 23_456)]);
        assert_eq!(Table::from_file(&table.to_text()).unwrap(), table);
    }

    #[test]
    fn the_log_gives_its_bench_lines_only() {
        let log = "hello\nbench mul 3 4 101\n  1.0 error x\n";
        assert_eq!(Table::from_log(log).unwrap(), table(&[("mul", 3, 4)]));
        assert!(Table::from_log("hello\n").unwrap_err().contains("no stage"));
        assert!(
            Table::from_log("bench mul three\n")
                .unwrap_err()
                .contains("mul three")
        );
    }
}
