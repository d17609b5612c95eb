//! What a correction came to.

use std::fmt::Write;

use leadscrew_nc::coordinates::Coordinates;
use leadscrew_nc::corrector;
use leadscrew_nc::terms::watch::Largest;
use serde::Serialize;

/// What a correction came to.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    schema: &'static str,
    blocks: u64,
    blocks_changed: u64,
    blocks_added: u64,
    bytes_read: u64,
    bytes_written: u64,
    seconds: f64,
    megabytes_per_s: f64,
    /// Peak of resident memory above where the work began; none where the system does not tell.
    memory_growth_kb: Option<u64>,
    terms: Vec<TermReport>,
}

/// Largest corrections of a term by axis, mm or degrees.
#[derive(Debug, Serialize)]
struct TermReport {
    name: String,
    largest: Vec<AxisReport>,
}

#[derive(Debug, Serialize)]
struct AxisReport {
    axis: char,
    value: f64,
    unit: &'static str,
}

fn axes(largest: &Coordinates) -> Vec<AxisReport> {
    largest
        .iter()
        .filter(|(_, value)| *value > 0.0)
        .map(|(axis, value)| AxisReport {
            axis: axis.letter(),
            value,
            unit: axis.unit(),
        })
        .collect()
}

impl Report {
    pub fn new(
        done: &corrector::Report,
        largest: &[Largest],
        seconds: f64,
        memory_growth_kb: Option<u64>,
    ) -> Self {
        Self {
            schema: "leadscrew/correct/1",
            blocks: done.blocks,
            blocks_changed: done.changed,
            blocks_added: done.added,
            bytes_read: done.bytes_read,
            bytes_written: done.bytes_written,
            seconds,
            megabytes_per_s: done.bytes_read as f64 / 1e6 / seconds.max(1e-9),
            memory_growth_kb,
            terms: largest
                .iter()
                .map(|term| TermReport {
                    name: term.name().to_owned(),
                    largest: axes(&term.values()),
                })
                .collect(),
        }
    }

    pub fn to_text(&self) -> String {
        let mut text = format!(
            "{} blocks read, {} changed, {} added; {} bytes read, {} written\n",
            self.blocks,
            self.blocks_changed,
            self.blocks_added,
            self.bytes_read,
            self.bytes_written
        );
        for term in &self.terms {
            let _ = write!(text, "largest K of \"{}\":", term.name);
            if term.largest.is_empty() {
                text.push_str(" none");
            }
            for AxisReport { axis, value, unit } in &term.largest {
                let _ = write!(text, " {axis} {value:.4} {unit}");
            }
            text.push('\n');
        }
        let _ = write!(
            text,
            "{:.3} s, {:.1} MB/s",
            self.seconds, self.megabytes_per_s
        );
        if let Some(growth) = self.memory_growth_kb {
            let _ = write!(text, ", memory grew by {growth} KB");
        }
        text.push('\n');
        text
    }
}

/// Resident memory at a moment, KB, where the system tells.
pub(super) struct Memory(Option<u64>);

impl Memory {
    pub fn now() -> Self {
        Self(status("VmRSS:"))
    }

    /// The peak since the start of the process above this moment.
    pub fn growth(&self) -> Option<u64> {
        Some(status("VmHWM:")?.saturating_sub(self.0?))
    }
}

fn status(key: &str) -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with(key))?;
    line.split_whitespace().nth(1)?.parse().ok()
}
