//! Arguments of `plan`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::RateArgs;

/// A figure of the paper on cycle frequencies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PlanFigure {
    /// Feed allowed by acceleration and by jerk against the radius
    #[value(name = "3")]
    AllowedFeed,
    /// Cycle frequency against the feed, with the limits of overload and jerk
    #[value(name = "4")]
    FrequencyAgainstFeed,
    /// Cycle frequency against the resolution
    #[value(name = "5")]
    FrequencyAgainstResolution,
}

/// Arguments of `plan`.
#[derive(Debug, Args)]
pub struct PlanArgs {
    // Not `machine`: that of the port is known to every command.
    /// The machine; without it a summary of all
    #[arg(value_name = "MACHINE")]
    pub subject: Option<String>,
    /// List machines and encoders, and stop
    #[arg(long, conflicts_with_all = ["subject", "plot", "encoder"])]
    pub list: bool,
    /// Add the machines and encoders of FILE to the built-in ones; may be given more than once
    #[arg(long, value_name = "FILE.toml")]
    pub catalogue: Vec<PathBuf>,
    /// Try this encoder on the axes with a screw and on the spindles
    #[arg(long, value_name = "NAME", requires = "subject")]
    pub encoder: Option<String>,
    /// Its lines a revolution, where it comes with several numbers
    #[arg(
        long,
        value_name = "Z",
        requires = "encoder",
        allow_negative_numbers = true
    )]
    pub lines: Option<f64>,
    /// How often the core ticks
    #[command(flatten)]
    pub rate: RateArgs,
    /// Chord error that is allowed, d
    #[arg(
        long,
        value_name = "D",
        default_value_t = 1.0,
        allow_negative_numbers = true
    )]
    pub chord: f64,
    /// Highest frequency of a channel where that of the encoder is not known, kHz
    #[arg(
        long,
        value_name = "KHZ",
        default_value_t = 300.0,
        allow_negative_numbers = true
    )]
    pub line_khz: f64,
    /// Radii of contours, mm
    #[arg(
        long,
        value_name = "R,…",
        value_delimiter = ',',
        default_value = "0.25,0.5,1,2,5,10,20,50,100",
        allow_negative_numbers = true
    )]
    pub radius: Vec<f64>,
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
    /// Draw a figure to FILE.svg or FILE.png
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Which: 3 (of MACHINE, or of the paper's three axes), 4 or 5
    #[arg(
        long,
        value_name = "N",
        value_enum,
        default_value = "3",
        requires = "plot"
    )]
    pub figure: PlanFigure,
}
