//! Commands that work on an axis behind `--port`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::{
    BodeArgs, JsonArgs, NullOffsetArgs, ProbeArgs, RecordArgs, ScopeArgs, ScrewTableCommand,
    SetupArgs,
};

/// What works on an axis.
#[derive(Debug, Subcommand)]
pub enum AxisCommand {
    /// Tells how the axis stands
    Status(JsonArgs),
    /// Tells what the axis is: firmware, board, what it can do
    Identity(JsonArgs),
    /// Tells what stopped the axis, why, and what to do
    Faults(JsonArgs),
    /// Clears the fault, whose cause is gone, and the warnings
    Clear(JsonArgs),
    /// Puts the axis under control and waits until it is ready
    Enable(JsonArgs),
    /// Stops the axis, closes its brake and switches its drive off
    Disable(JsonArgs),
    /// Finds the origin
    Home(JsonArgs),
    /// Moves the axis to a place, or by a distance, and waits until it is there
    Move(MoveArgs),
    /// Goes towards a place until the touch probe touches, then back, once or many times
    Probe(ProbeArgs),
    /// Moves the axis until Ctrl-C, or for a time
    Jog(JogArgs),
    /// Feed hold: stops the axis, which remembers its target
    Hold(JsonArgs),
    /// Ends a feed hold
    Resume(JsonArgs),
    /// Stops the axis, which forgets its target
    Stop(JsonArgs),
    /// Sets the feed override
    Override(OverrideArgs),
    /// Tells what its tick and its link counted: late ticks, lost records, indexes of the encoder
    Counters(JsonArgs),
    /// Starts the firmware anew, while the axis is off; what was not saved is lost
    Restart(JsonArgs),
    /// Shows, sets, saves and restores what is set on the axis
    #[command(subcommand)]
    Params(ParamsCommand),
    /// Writes, reads and erases the screw error table that the axis keeps
    #[command(subcommand)]
    ScrewTable(ScrewTableCommand),
    /// Runs a script of moves and checks, for acceptance
    Run(RunArgs),
    /// Keeps the axis of --port qemu or sim running, for other commands to reach it by --port tcp:…
    Serve(ServeArgs),
    /// Commissions the axis from factory settings, step by step: polarity, direction, index, drive, loop, encoder, offset
    Setup(SetupArgs),
    /// Measures the offset of the drive and sets the loop against it
    NullOffset(NullOffsetArgs),
    /// Records up to 8 signals in the tick, around a trigger, without loss
    Scope(ScopeArgs),
    /// Records telemetry for a time, into a file that `replay` reads
    Record(RecordArgs),
    /// Shows the axis on the terminal, live, with keys to jog and stop it
    Monitor,
    /// Measures frequency responses of drive and closed loop by chirps
    Bode(BodeArgs),
}

/// Arguments of `move`.
#[derive(Debug, Args)]
pub struct MoveArgs {
    /// Where to, mm from the origin
    #[arg(
        value_name = "TARGET_MM",
        allow_negative_numbers = true,
        required_unless_present = "by"
    )]
    pub target: Option<f64>,
    /// By how far instead, mm, from where it should be now
    #[arg(
        long,
        value_name = "MM",
        allow_negative_numbers = true,
        conflicts_with = "target"
    )]
    pub by: Option<f64>,
    /// Feed, mm/min
    #[arg(long, value_name = "MM_PER_MIN", allow_negative_numbers = true)]
    pub feed: f64,
    /// How it is told
    #[command(flatten)]
    pub output: JsonArgs,
}

/// Arguments of `jog`.
#[derive(Debug, Args)]
pub struct JogArgs {
    /// Feed, mm/min; negative for the other way
    #[arg(value_name = "FEED", allow_negative_numbers = true)]
    pub feed: f64,
    /// For so long; else until Ctrl-C
    #[arg(long = "for", value_name = "SECONDS", allow_negative_numbers = true)]
    pub seconds: Option<f64>,
    /// How it is told
    #[command(flatten)]
    pub output: JsonArgs,
}

/// Arguments of `override`.
#[derive(Debug, Args)]
pub struct OverrideArgs {
    /// Share of the feed that is asked for, %: 0 to 200
    #[arg(value_name = "PERCENT", allow_negative_numbers = true)]
    pub percent: i32,
    /// How it is told
    #[command(flatten)]
    pub output: JsonArgs,
}

/// What is done with parameters.
#[derive(Debug, Subcommand)]
pub enum ParamsCommand {
    /// Lists them with value, unit, range and default
    List {
        /// Only this section
        section: Option<String>,
        /// How it is told
        #[command(flatten)]
        output: JsonArgs,
    },
    /// Tells one
    Get {
        /// Section and name, with a point between them
        name: String,
        /// How it is told
        #[command(flatten)]
        output: JsonArgs,
    },
    /// Sets one or several at once, while the axis is off: all of them are taken, or none
    Set {
        /// NAME VALUE, or NAME=VALUE for each; a value may have its unit behind it, as 9000mm/min
        #[arg(
            value_name = "NAME=VALUE",
            required = true,
            allow_negative_numbers = true
        )]
        values: Vec<String>,
        /// Save all parameters afterwards
        #[arg(long)]
        save: bool,
        /// How it is told
        #[command(flatten)]
        output: JsonArgs,
    },
    /// Saves what is in force, so that it is there after the axis was switched off
    Save(JsonArgs),
    /// Writes all of them to a file
    Backup {
        /// The file
        #[arg(value_name = "FILE.toml")]
        file: PathBuf,
        /// Write the saved encoder map and screw table too, to FILE.map and FILE.screw
        #[arg(long)]
        calibration: bool,
        /// How it is told
        #[command(flatten)]
        output: JsonArgs,
    },
    /// Sets all of them as a file has them, while the axis is off; what it leaves out gets its default
    Restore {
        /// The file
        #[arg(value_name = "FILE.toml")]
        file: PathBuf,
        /// Save the encoder map and the screw table of FILE.map and FILE.screw too
        #[arg(long)]
        calibration: bool,
        /// Save all parameters afterwards
        #[arg(long)]
        save: bool,
        /// How it is told
        #[command(flatten)]
        output: JsonArgs,
    },
    /// Tells which differ from a file, or from their defaults
    Diff {
        /// The file
        #[arg(value_name = "FILE.toml", conflicts_with = "defaults")]
        file: Option<PathBuf>,
        /// From the defaults, as without a file
        #[arg(long)]
        defaults: bool,
        /// How it is told
        #[command(flatten)]
        output: JsonArgs,
    },
    /// Erases all that is saved, encoder map and screw table too, and starts the axis anew with factory settings
    Reset {
        /// Do not ask
        #[arg(long)]
        yes: bool,
        /// Keep encoder map and screw table
        #[arg(long)]
        keep_calibration: bool,
        /// How it is told
        #[command(flatten)]
        output: JsonArgs,
    },
}

/// Arguments of `run`.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// The script: docs/commissioning.md tells what it may say
    #[arg(value_name = "SCRIPT")]
    pub script: PathBuf,
    /// Only check the script
    #[arg(long)]
    pub check: bool,
    /// Leave the axis as it is when a step fails; else it is stopped and disabled
    #[arg(long)]
    pub keep: bool,
    /// How it is told
    #[command(flatten)]
    pub output: JsonArgs,
}

/// Arguments of `serve`.
#[derive(Debug, Args)]
pub struct ServeArgs {
    /// Address of this computer on which the link is served; port 0 for any that is free
    #[arg(long, value_name = "127.0.0.1:PORT", default_value = "127.0.0.1:0")]
    pub listen: String,
    /// Serve the link on a pseudo-terminal instead (qemu)
    #[arg(long, conflicts_with = "listen")]
    pub pty: bool,
    /// Serve Modbus too, on a port of this computer; 0 for any that is free (qemu)
    #[arg(long, value_name = "PORT")]
    pub modbus: Option<u16>,
    /// How it is told
    #[command(flatten)]
    pub output: JsonArgs,
}
