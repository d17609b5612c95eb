//! Arguments of `measure`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `measure`.
#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("input").required(true).multiple(true).args(["touches", "log", "program"]))]
pub struct MeasureArgs {
    /// The part: its features and where to touch them
    #[arg(value_name = "PART.toml")]
    pub part: PathBuf,
    /// Touches as a table
    #[arg(long, value_name = "FILE.csv", conflicts_with = "log")]
    pub touches: Option<PathBuf>,
    /// Touches as LinuxCNC logged them when it ran the program of --program
    #[arg(long, value_name = "FILE.txt")]
    pub log: Option<PathBuf>,
    /// Write the program that touches the part and logs it, for LinuxCNC
    #[arg(long, value_name = "FILE.ngc", conflicts_with_all = ["touches", "log"])]
    pub program: Option<PathBuf>,
    /// Leave touches out that do not fit the others; without this they are flagged and count
    #[arg(long, conflicts_with = "program")]
    pub without_outliers: bool,
    /// Probability to flag any touch of a good feature (more than 0, less than 1)
    #[arg(
        long,
        value_name = "P",
        default_value_t = 0.01,
        allow_negative_numbers = true
    )]
    pub level: f64,
    /// Print the report as JSON, alone, on standard output
    #[arg(long, conflicts_with = "program")]
    pub json: bool,
    /// Draw the residuals of every touch to FILE.svg or FILE.png
    #[arg(long, value_name = "FILE", conflicts_with = "program")]
    pub plot: Option<PathBuf>,
}
