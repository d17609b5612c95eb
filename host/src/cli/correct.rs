//! Arguments of `correct`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `correct`.
#[derive(Debug, Args)]
pub struct CorrectArgs {
    /// The NC program, or - for standard input
    pub program: PathBuf,
    /// What the control knows and what is to be corrected
    #[arg(long, value_name = "SETUP.toml")]
    pub setup: PathBuf,
    /// The dialect of the program: one that is built in, or a file [default: that of the setup]
    #[arg(long, value_name = "NAME|FILE.toml")]
    pub dialect: Option<String>,
    /// Where the corrected program goes: a file, replaced as a whole and only if no block is refused, or - for standard output,
    /// block by block
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    pub out: PathBuf,
    /// Write nothing: only tell whether a block is refused
    #[arg(long)]
    pub check: bool,
    /// Correct nothing: the program comes out as it is, byte by byte
    #[arg(long)]
    pub identity: bool,
    /// Tell what was changed, the largest corrections and the throughput; beside a program on standard output on standard error
    #[arg(long)]
    pub report: bool,
    /// Print that report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
}
