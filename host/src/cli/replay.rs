//! Arguments of `replay`.

use std::path::PathBuf;

use clap::Args;

use super::{ChannelArgs, OutputArgs, RateArgs, estimator_names};

/// Arguments of `replay`.
#[derive(Debug, Args)]
pub struct ReplayArgs {
    /// The capture: VCD, sigrok CSV or Saleae Logic 2 CSV; or a recording of `scope` or `record`, whose core is run again
    pub file: PathBuf,
    /// How often the core ticks
    #[command(flatten)]
    pub rate: RateArgs,
    /// Its channels
    #[command(flatten)]
    pub channels: ChannelArgs,
    /// Only this estimator [default: all in the report, exponential in the CSV]
    #[arg(long, value_name = "NAME", value_parser = estimator_names())]
    pub estimator: Option<String>,
    /// Window of that estimator, ticks: 1 to 64 for simple, 4 to 64 for polynomial [default: 15]
    #[arg(
        long,
        value_name = "W",
        requires = "estimator",
        allow_negative_numbers = true
    )]
    pub window: Option<u32>,
    /// Instant that polynomial answers for: its window's centre or the newest sample [default: newest]
    #[arg(long, value_name = "INSTANT", requires = "estimator", value_parser = ["centre", "newest"])]
    pub answer: Option<String>,
    /// The encoder's map; all of it but its phases is tied to the index, which --z names
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Start of the span over which acceleration is fitted, s [default: after warm-up]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub from_s: Option<f64>,
    /// End of that span, s [default: the end]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub to_s: Option<f64>,
    /// Where results go
    #[command(flatten)]
    pub output: OutputArgs,
}
