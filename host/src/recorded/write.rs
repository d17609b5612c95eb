//! Recordings into files.

use std::io::{self, Write};

use super::{FIRST_LINE, Recorded};

/// Writes a recording.
///
/// # Errors
/// Of the writer.
pub fn write(recorded: &Recorded, out: &mut dyn Write) -> io::Result<()> {
    let recording = &recorded.recording;
    writeln!(out, "{FIRST_LINE}")?;
    for line in recorded.header.to_toml(recording).lines() {
        writeln!(out, "# {line}")?;
    }
    write!(out, "tick,time_s")?;
    for signal in &recording.signals {
        write!(out, ",{signal}")?;
    }
    writeln!(out)?;
    let every = i64::from(recording.every.max(1));
    let physical: Vec<_> = recording
        .signals
        .iter()
        .map(|&signal| recording.physical(signal))
        .collect();
    let mut due = None;
    for (row, (tick, time)) in recording.ticks.iter().zip(recording.times()).enumerate() {
        if let Some(due) = due
            && *tick > due
        {
            writeln!(out, "# {} samples are missing here", (tick - due) / every)?;
        }
        due = Some(tick + every);
        write!(out, "{tick},{time:.6}")?;
        for (physical, column) in physical.iter().zip(&recording.columns) {
            let bits = column.get(row).copied().unwrap_or(0);
            write!(out, ",{}", physical.value(bits))?;
        }
        writeln!(out)?;
    }
    Ok(())
}
