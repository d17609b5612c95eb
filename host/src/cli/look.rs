//! Arguments of what looks at an axis.

use std::path::PathBuf;

use clap::Args;
use leadscrew::scope::Signal;

use super::YesArgs;
use crate::axis::scope::{Before, TriggerText, signal};
use crate::recorded::REPLAY_SIGNALS;

/// Signals by their names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SignalList(pub Vec<Signal>);

fn signals(text: &str) -> Result<SignalList, String> {
    if text == "replay" {
        return Ok(SignalList(REPLAY_SIGNALS.to_vec()));
    }
    let list: Vec<_> = text
        .split(',')
        .map(|name| signal(name.trim()))
        .collect::<Result<_, _>>()?;
    if list.len() > leadscrew::scope::MOST_SIGNALS {
        let most = leadscrew::scope::MOST_SIGNALS;
        return Err(format!("{} signals: name {most} at most", list.len()));
    }
    Ok(SignalList(list))
}

/// `30%` or `0.2s`.
fn before(text: &str) -> Result<Before, String> {
    let number = |text: &str| {
        let number = text.trim().parse().ok();
        number.filter(|number: &f64| number.is_finite() && *number >= 0.0)
    };
    let found = if let Some(share) = text.strip_suffix('%') {
        number(share)
            .filter(|share| *share < 100.0)
            .map(|share| Before::Share(share / 100.0))
    } else {
        text.strip_suffix('s').and_then(number).map(Before::Seconds)
    };
    found.ok_or_else(|| "expected a share below 100 %, as 25%, or a time, as 0.2s".to_owned())
}

fn seconds(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|number: &f64| *number > 0.0 && *number <= 1e6);
    number.ok_or_else(|| "expected seconds, above 0".to_owned())
}

/// Arguments of `scope`.
#[derive(Debug, Args)]
pub struct ScopeArgs {
    /// Up to 8 signals of docs/scope.md, by commas, or `replay`: those by which `leadscrew replay` re-runs the core [default:
    /// reported_position,commanded_position,following_error,command]
    #[arg(long, value_name = "A,B,…", value_parser = signals)]
    pub signals: Option<SignalList>,
    /// How long to record, s [default: as long as there is memory]
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub seconds: Option<f64>,
    /// Ticks from sample to sample [default: as few as the memory allows]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub every: Option<u16>,
    /// What to wait for: now, fault, fault:NAME, warning, motion, `SIGNAL>LEVEL`, `SIGNAL<LEVEL`, `SIGNAL rising LEVEL`,
    /// `SIGNAL falling LEVEL`; levels in mm, mm/min, m/s², %
    #[arg(long, value_name = "TRIGGER", default_value = "now")]
    pub trigger: TriggerText,
    /// What of the recording lies before the trigger: a share, as 25%, or a time, as 0.2s
    #[arg(long, value_name = "SHARE|S", default_value = "25%", value_parser = before)]
    pub before: Before,
    /// Make a move to this position once the scope is armed, mm from the origin; an axis that is off is enabled for it
    #[arg(
        long = "move",
        value_name = "MM",
        requires = "feed",
        allow_negative_numbers = true
    )]
    pub target: Option<f64>,
    /// Feed of that move, mm/min
    #[arg(long, value_name = "MM_PER_MIN", requires = "target")]
    pub feed: Option<f64>,
    /// How long to wait for the trigger, s
    #[arg(long, value_name = "S", default_value = "60", value_parser = seconds)]
    pub wait: f64,
    /// Where the recording goes
    #[command(flatten)]
    pub to: RecordingArgs,
}

/// Where a recording goes.
#[derive(Debug, Args)]
pub struct RecordingArgs {
    /// Write the recording to FILE.csv, with all that `leadscrew replay` needs
    #[arg(long, value_name = "FILE.csv")]
    pub out: Option<PathBuf>,
    /// Draw the signals to FILE.svg or FILE.png
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Print the summary as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `record`.
#[derive(Debug, Args)]
pub struct RecordArgs {
    /// How long to record, s of the axis
    #[arg(long, value_name = "S", default_value = "10", value_parser = seconds)]
    pub seconds: f64,
    /// Ticks from record to record
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    pub every: u16,
    /// Where the recording goes
    #[command(flatten)]
    pub to: RecordingArgs,
}

/// Arguments of `bode`.
#[derive(Debug, Args)]
pub struct BodeArgs {
    /// Only the drive's response, or only the closed loop's [default: both]
    #[arg(long, value_name = "WHAT", value_parser = ["drive", "loop"])]
    pub only: Option<String>,
    /// Lowest frequency, Hz
    #[arg(long, value_name = "HZ", default_value_t = 1.0)]
    pub from_hz: f64,
    /// Highest frequency, Hz
    #[arg(long, value_name = "HZ", default_value_t = 40.0)]
    pub to_hz: f64,
    /// Length of each chirp, s
    #[arg(long, value_name = "S", default_value = "6", value_parser = seconds)]
    pub seconds: f64,
    /// Amplitude of the drive's chirp, % of full command
    #[arg(long, value_name = "%", default_value_t = 3.0)]
    pub amplitude: f64,
    /// Amplitude of the closed loop's chirp, % of full command; it turns the axis back, so friction has to be small beside it
    #[arg(long, value_name = "%", default_value_t = 10.0)]
    pub loop_amplitude: f64,
    /// Command about which the drive's chirp swings, % of full command; negative: the axis goes backward
    #[arg(
        long,
        value_name = "%",
        default_value_t = 6.0,
        allow_negative_numbers = true
    )]
    pub centre: f64,
    /// Frequencies that are looked at
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u16).range(2..=200))]
    pub points: u16,
    /// Most that the axis may move, mm
    #[arg(long, value_name = "MM", default_value_t = 100.0)]
    pub travel_mm: f64,
    /// Who is asked
    #[command(flatten)]
    pub yes: YesArgs,
    /// Draw the responses to FILE.svg or FILE.png
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
}
