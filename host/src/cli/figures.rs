//! Arguments of what measures on simulated machines of reference: `accuracy` and `tracking`.

use clap::Args;

/// Arguments of `accuracy`.
#[derive(Debug, Args)]
pub struct AccuracyArgs {
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `tracking`.
#[derive(Debug, Args)]
pub struct TrackingArgs {
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
    /// Search the gains of the hand-tuned peer anew, print them and stop (a minute or two)
    #[arg(long, conflicts_with = "json")]
    pub tune_linuxcnc: bool,
}
