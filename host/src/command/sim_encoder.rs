//! `leadscrew sim-encoder`: a capture of the simulated encoder.

use leadscrew_hal_mock::disc::DiscParams;
use leadscrew_hal_mock::encoder::EncoderModel;

use super::{check_replaceable, print, write_file};
use crate::cli::SimEncoderArgs;
use crate::error::CommandError;
use crate::progress::Progress;
use crate::sim_encoder::Runs;

/// Slowest and fastest run, d/ms: several counts a tick, and no more than a velocity tells.
const SPEEDS: (f64, f64) = (5.0, 2000.0);
/// Edges a revolution that the simulator has and a map can be learned of.
const EDGES: (u32, u32) = (512, 16_384);
/// Most edges: each takes some 50 bytes until it is written.
const MOST_EDGES: f64 = 2e7;

/// Runs the command.
///
/// # Errors
/// Bad usage, or a file that cannot be written.
pub fn run(args: &SimEncoderArgs) -> Result<(), CommandError> {
    check(args)?;
    check_replaceable("--out", &args.out, None)?;
    let model = EncoderModel {
        disc: DiscParams {
            edges_per_revolution: f64::from(args.edges_per_rev),
            ..DiscParams::default()
        },
        ..EncoderModel::real()
    };
    let runs = Runs {
        model,
        seed: args.seed,
        velocities: args.velocities.clone(),
        revolutions: args.revolutions,
        sways: !args.steady,
    };
    let recording = {
        let _running = Progress::endless("running");
        let recorded = runs.record();
        recorded.map_err(|error| CommandError::Usage(error.to_string()))?
    };
    {
        let _writing = Progress::endless("writing");
        write_file(&args.out, |file| recording.write_vcd(file))?;
    }
    print(&format!(
        "{}: {} runs of {} revolutions of {} edges, {:.2} s; signals A, B, Z\n",
        args.out.display(),
        args.velocities.len(),
        args.revolutions,
        args.edges_per_rev,
        recording.duration as f64 / recording.clock_hz as f64,
    ))
}

fn check(args: &SimEncoderArgs) -> Result<(), CommandError> {
    let (slowest, fastest) = SPEEDS;
    let usage = |text: String| Err(CommandError::Usage(text));
    let good = |velocity: &f64| (slowest..=fastest).contains(&velocity.abs());
    if let Some(velocity) = args.velocities.iter().find(|velocity| !good(velocity)) {
        return usage(format!(
            "--velocities {velocity}: allowed are {slowest} to {fastest} d/ms and the same backward"
        ));
    }
    if !(EDGES.0..=EDGES.1).contains(&args.edges_per_rev) || !args.edges_per_rev.is_multiple_of(4) {
        return usage(format!(
            "--edges-per-rev {}: expected a multiple of 4 from {} to {}",
            args.edges_per_rev, EDGES.0, EDGES.1
        ));
    }
    let edges = args.revolutions * f64::from(args.edges_per_rev) * args.velocities.len() as f64;
    if !(args.revolutions >= 1.0 && edges <= MOST_EDGES) {
        return usage(format!(
            "--revolutions {}: at least 1, and all runs together {MOST_EDGES:.0} edges at most",
            args.revolutions
        ));
    }
    Ok(())
}
