//! The comments before the samples: rate and channels.

use std::io::BufRead;

use crate::recording::decimal::Decimal;
use crate::recording::error::{Located, Problem};
use crate::recording::lines::Lines;

/// What the comments say.
pub(super) struct Preamble {
    /// Names of the channels in the order of their columns.
    pub channels: Option<Vec<String>>,
    rate: Option<FileRate>,
}

struct FileRate {
    hz: u64,
    line: u64,
}

impl Preamble {
    /// Reads the comments; the first row after them is then the current line.
    pub(super) fn read<R: BufRead>(lines: &mut Lines<R>) -> Result<Preamble, Located> {
        let mut preamble = Preamble {
            channels: None,
            rate: None,
        };
        while lines.advance()? {
            let Some(comment) = lines.bytes().strip_prefix(b";") else {
                return Ok(preamble);
            };
            let comment = str::from_utf8(comment)
                .map_err(|_| Problem::NotUtf8.at(lines.number()))?
                .trim();
            if let Some(rate) = comment.strip_prefix("Samplerate:") {
                let hz = frequency(rate).ok_or_else(|| {
                    lines.broken(
                        "a sample rate such as `1 MHz`",
                        "correct the comment, or take it out and pass --samplerate in hertz",
                    )
                })?;
                preamble.rate = Some(FileRate {
                    hz,
                    line: lines.number(),
                });
            } else if let Some(channels) = comment.strip_prefix("Channels (") {
                preamble.channels = channel_names(channels);
            }
        }
        Err(Problem::NoSamples.into())
    }

    /// The rate in hertz: the file's, else the caller's.
    pub(super) fn rate(&self, given_hz: Option<u64>) -> Result<u64, Located> {
        match (&self.rate, given_hz) {
            (_, Some(0)) => Err(Problem::ZeroSamplerate.into()),
            (Some(file), Some(given_hz)) if file.hz != given_hz => {
                Err(Problem::SamplerateConflict {
                    in_file_hz: file.hz,
                    given_hz,
                }
                .at(file.line))
            }
            (Some(file), _) => Ok(file.hz),
            (None, Some(given_hz)) => Ok(given_hz),
            (None, None) => Err(Problem::NoSamplerate.into()),
        }
    }
}

/// `1 MHz`, `12.5 MHz`, `999 Hz`; None unless it is a whole positive number of hertz.
fn frequency(text: &str) -> Option<u64> {
    const UNITS: [(&str, u32); 4] = [("GHz", 9), ("MHz", 6), ("kHz", 3), ("Hz", 0)];
    let text = text.trim();
    let mut units = UNITS.into_iter();
    let (number, digits) =
        units.find_map(|(unit, digits)| Some((text.strip_suffix(unit)?, digits)))?;
    // In units of 10^-digits of the unit, which is the hertz.
    let hz = Decimal::parse(number.trim())?.in_units(digits)?;
    u64::try_from(hz).ok().filter(|hz| *hz > 0)
}

/// The names in `2/8): A, B`. Where a name holds the separator they cannot be told apart, and the
/// channels go by their numbers.
fn channel_names(comment: &str) -> Option<Vec<String>> {
    let (counts, names) = comment.split_once("):")?;
    let count: usize = counts.split('/').next()?.parse().ok()?;
    let names: Vec<String> = names
        .split(", ")
        .map(|name| name.trim().to_owned())
        .collect();
    match names.len() == count {
        true => Some(names),
        false => Some((0..count).map(|index| index.to_string()).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::{channel_names, frequency};

    #[test]
    fn rates_as_libsigrok_writes_them() {
        let rates = [
            ("1 Hz", 1),
            ("999 Hz", 999),
            ("1.5 kHz", 1_500),
            ("1.234567 MHz", 1_234_567),
            ("16.666667 MHz", 16_666_667),
            ("2.5 GHz", 2_500_000_000),
        ];
        for (text, hz) in rates {
            assert_eq!(frequency(text), Some(hz), "{text}");
        }
        for text in [
            "",
            "1",
            "MHz",
            "0 Hz",
            "-1 Hz",
            "1.5 Hz",
            "1.2345 kHz",
            "1 mHz",
            "1 M",
        ] {
            assert_eq!(frequency(text), None, "{text}");
        }
    }

    #[test]
    fn channels_go_by_number_where_names_hold_the_separator() {
        assert_eq!(
            channel_names("2/8): A, B"),
            Some(vec!["A".into(), "B".into()])
        );
        assert_eq!(
            channel_names("2/8): A, B, C"),
            Some(vec!["0".into(), "1".into()])
        );
        assert_eq!(channel_names("16/16)"), None);
    }
}
