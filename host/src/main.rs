//! The `leadscrew` command.

use std::io::Write;
use std::process::ExitCode;

use leadscrew_host::cli::{Cli, Command};
use leadscrew_host::command::axis::OnAxis;
use leadscrew_host::command::{
    accuracy, autotune, axis, calibrate_axis, calibrate_encoder, calibrate_probe, correct, demo,
    deviations, identify, measure, plan, prove_out, replay, sim, sim_encoder, tracking,
    tune_filter,
};

fn main() -> ExitCode {
    let Cli { port, command } = Cli::read();
    let on_axis = |command| axis::run_on_axis(&port, command);
    let is_on_axis = port.port.is_some();
    let done = match command {
        Some(Command::CalibrateEncoder(args)) if is_on_axis => {
            on_axis(OnAxis::CalibrateEncoder(&args))
        }
        Some(Command::Identify(args)) if is_on_axis => on_axis(OnAxis::Identify(&args)),
        Some(Command::Autotune(args)) if is_on_axis => on_axis(OnAxis::Autotune(&args)),
        None => demo::run(),
        Some(Command::Sim(args)) => sim::run(&args),
        Some(Command::Plan(args)) => plan::run(&args),
        Some(Command::Replay(args)) => replay::run(&args),
        Some(Command::CalibrateEncoder(args)) => calibrate_encoder::run(&args),
        Some(Command::CalibrateAxis(args)) => calibrate_axis::run(&args),
        Some(Command::SimEncoder(args)) => sim_encoder::run(&args),
        Some(Command::Accuracy(args)) => accuracy::run(&args),
        Some(Command::Tracking(args)) => tracking::run(&args),
        Some(Command::Identify(args)) => identify::run(&args),
        Some(Command::Autotune(args)) => autotune::run(&args),
        Some(Command::TuneFilter(args)) => tune_filter::run(&args),
        Some(Command::Correct(args)) => correct::run(&args),
        Some(Command::Deviations(args)) => deviations::run(&args),
        Some(Command::ProveOut(args)) => prove_out::run(&args),
        Some(Command::CalibrateProbe(command)) => calibrate_probe::run(&command),
        Some(Command::Measure(args)) => measure::run(&args),
        Some(Command::Axis(command)) => axis::run(&port, &command),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Nobody may be listening: that is no reason to panic, the exit code tells as well.
            let _ = writeln!(std::io::stderr(), "error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
