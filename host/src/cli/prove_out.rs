//! Arguments of `prove-out`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `prove-out`.
#[derive(Debug, Args)]
pub struct ProveOutArgs {
    /// Seed of all that is wrong, and of all noise
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Repeatability of the probe, 2σ in µm, 0.01 to 50
    #[arg(long, value_name = "UM", default_value_t = 1.0)]
    pub probe_um: f64,
    /// Write the corrected program to FILE
    #[arg(long, value_name = "FILE.ngc")]
    pub corrected: Option<PathBuf>,
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
    /// Draw the part before and after, its deviations enlarged, to FILE.svg or FILE.png
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}
