//! The `leadscrew` command.

use std::process::ExitCode;

use clap::Parser;
use leadscrew_host::cli::{Cli, Command};
use leadscrew_host::command::{demo, replay, sim};

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        None => demo::run(),
        Some(Command::Sim(args)) => sim::run(&args),
        Some(Command::Replay(args)) => replay::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
