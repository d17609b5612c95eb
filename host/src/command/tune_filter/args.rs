//! Arguments of `tune-filter`.

use std::path::PathBuf;

use clap::Args;

use super::scenes::SceneName;
use crate::cli::{ChannelArgs, RateArgs};

/// What the figures mean.
const MEASURES: &str = "\
t_z is the lag of the acceleration, lag_a, as the estimator computes it (P2's own 8 ticks are read off transients).
On a scene σ is the rms error of the acceleration against the truth at its instant. A capture has no truth: there σ
is the rms difference from the trend, the acceleration of a least-squares quadratic through the counts of the 101
ticks about the estimate's instant, over stretches where the axis keeps moving one way and the quadratic fits to 2 d
rms. So what the encoder does wrong over much more than 101 ticks is not in σ, and what the axis really does within
fewer is; √(720/12/101⁵) = 8e-5 d/tick² of rounding to counts is in it too.";

/// Arguments of `tune-filter`.
#[derive(Debug, Args)]
#[command(after_help = MEASURES)]
pub struct TuneFilterArgs {
    /// A capture of steady motion: VCD, sigrok CSV or Saleae Logic 2 CSV
    #[arg(conflicts_with = "scene")]
    pub file: Option<PathBuf>,
    /// A simulated scene instead
    #[arg(long, value_enum, value_name = "NAME", conflicts_with_all = ["a", "b", "z", "samplerate"])]
    pub scene: Option<SceneName>,
    /// How often the core ticks
    #[command(flatten)]
    pub rate: RateArgs,
    /// Weight of the lag in Φ, 1/tick
    #[arg(
        long,
        value_name = "C",
        default_value_t = 0.03,
        allow_negative_numbers = true
    )]
    pub lag_weight: f64,
    /// Weight of σ in Φ, tick²/d
    #[arg(
        long,
        value_name = "C",
        default_value_t = 0.97,
        allow_negative_numbers = true
    )]
    pub sigma_weight: f64,
    /// Seed of a scene
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        conflicts_with = "file",
        allow_negative_numbers = true
    )]
    pub seed: u64,
    /// Channels of a capture
    #[command(flatten)]
    pub channels: ChannelArgs,
    /// The encoder's map; all of it but its phases is tied to the index, which --z names
    #[arg(long, value_name = "FILE", conflicts_with = "scene")]
    pub map: Option<PathBuf>,
    /// Start of the span of a capture that is judged, s [default: after warm-up]
    #[arg(
        long,
        value_name = "S",
        conflicts_with = "scene",
        allow_negative_numbers = true
    )]
    pub from_s: Option<f64>,
    /// End of that span, s [default: the end]
    #[arg(
        long,
        value_name = "S",
        conflicts_with = "scene",
        allow_negative_numbers = true
    )]
    pub to_s: Option<f64>,
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
    /// Draw σ and Φ over t_z to FILE.svg or FILE.png
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}
