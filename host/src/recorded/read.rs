//! Recordings out of files.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

use leadscrew::scope::Signal;
use leadscrew_client::{Physical, Recording};
use thiserror::Error;

use super::{FIRST_LINE, Header, Recorded};

/// First words of every version of the format.
const ANY_VERSION: &str = "# leadscrew recording ";

/// Why a recording cannot be used.
#[derive(Debug, Error)]
pub enum ReadError {
    /// It cannot be read.
    #[error("{}: cannot be read ({reason}): check the path and its permissions", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// Why.
        reason: io::Error,
    },
    /// It says something that is not understood.
    #[error("{}:{line}: {message}", file.display())]
    Content {
        /// The file.
        file: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong, and what was expected.
        message: String,
    },
}

/// True for a file that begins as recordings of an axis do, of whatever version. One that cannot be read is none.
#[must_use]
pub fn is_recording(path: &Path) -> bool {
    let is_file = path.metadata().is_ok_and(|found| found.is_file());
    let mut first = [0; ANY_VERSION.len()];
    // What is no file, as a pipe, would be short of what was read here.
    is_file
        && File::open(path)
            .and_then(|mut file| io::Read::read_exact(&mut file, &mut first))
            .is_ok()
        && first == *ANY_VERSION.as_bytes()
}

/// Reads a recording.
///
/// # Errors
/// [`ReadError`]
pub fn read(path: &Path) -> Result<Recorded, ReadError> {
    let failed = |reason| ReadError::Read {
        file: path.to_owned(),
        reason,
    };
    let file = File::open(path).map_err(failed)?;
    let mut reader = Reader::default();
    for (line, text) in (1..).zip(BufReader::new(file).lines()) {
        let text = text.map_err(failed)?;
        reader
            .line(line, &text)
            .map_err(|message| ReadError::Content {
                file: path.to_owned(),
                line,
                message,
            })?;
    }
    reader.finish().map_err(|message| ReadError::Content {
        file: path.to_owned(),
        line: 1,
        message,
    })
}

#[derive(Default)]
struct Reader {
    header: String,
    recorded: Option<Recorded>,
    physical: Vec<Physical>,
}

impl Reader {
    fn line(&mut self, number: usize, text: &str) -> Result<(), String> {
        if number == 1 {
            return match text.trim_end() {
                FIRST_LINE => Ok(()),
                other => Err(format!(
                    "`{other}` is not `{FIRST_LINE}`: use the tool of the version that recorded it"
                )),
            };
        }
        if let Some(comment) = text.strip_prefix('#') {
            if self.recorded.is_none() {
                self.header
                    .push_str(comment.strip_prefix(' ').unwrap_or(comment));
                self.header.push('\n');
            }
            return Ok(());
        }
        match &mut self.recorded {
            _ if text.trim().is_empty() => Ok(()),
            Some(recorded) => row(&mut recorded.recording, &self.physical, text),
            None => self.columns(text),
        }
    }

    /// The line that names the columns.
    fn columns(&mut self, text: &str) -> Result<(), String> {
        let (header, frame) = Header::from_toml(&self.header)?;
        let names = text.trim().strip_prefix("tick,time_s,");
        let names = names.ok_or_else(|| {
            "the columns are to begin with `tick,time_s`, and a signal or more".to_owned()
        })?;
        let signal = |name: &str| {
            Signal::from_name(name)
                .ok_or_else(|| format!("there is no signal `{name}`: docs/scope.md lists them"))
        };
        let signals: Vec<_> = names.split(',').map(signal).collect::<Result<_, _>>()?;
        let mut recording = Recording::new(frame.scale, &signals, frame.every);
        recording.trigger = frame.trigger;
        recording.is_torn = frame.is_torn;
        self.physical = signals
            .iter()
            .map(|&signal| recording.physical(signal))
            .collect();
        self.recorded = Some(Recorded { header, recording });
        Ok(())
    }

    fn finish(self) -> Result<Recorded, String> {
        let mut recorded = self
            .recorded
            .ok_or("the file ends before its samples begin")?;
        let samples = recorded.recording.len();
        if samples == 0 {
            return Err("there is no sample in it".to_owned());
        }
        let trigger = &mut recorded.recording.trigger;
        *trigger = trigger.map(|trigger| trigger.min(samples - 1));
        Ok(recorded)
    }
}

fn row(recording: &mut Recording, physical: &[Physical], text: &str) -> Result<(), String> {
    let mut cells = text.trim().split(',');
    let tick = cells.next().and_then(|cell| cell.parse::<i64>().ok());
    let tick = tick.ok_or("the first column is to be the number of a tick")?;
    if recording.ticks.last().is_some_and(|last| *last >= tick) {
        return Err("the ticks are to rise from row to row".to_owned());
    }
    // The time follows from the tick.
    let values: Vec<f64> = cells
        .skip(1)
        .map(|cell| cell.parse().ok().filter(|value: &f64| value.is_finite()))
        .collect::<Option<_>>()
        .ok_or("a value is no number")?;
    if values.len() != physical.len() {
        return Err(format!(
            "{} values where there are {} signals",
            values.len(),
            physical.len()
        ));
    }
    let bits = physical.iter().zip(&values);
    recording.push(tick, bits.map(|(physical, value)| physical.bits(*value)));
    Ok(())
}
