//! The demonstration: what each estimator of the papers makes of the same encoder.

use std::ops::RangeInclusive;
use std::path::Path;

use comfy_table::Table;
use leadscrew::encoder_map::EncoderMap;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;

use super::print;
use crate::calibration::{Procedure, learn_simulated};
use crate::error::CommandError;
use crate::figures::{self, acceleration_points, estimator_series, panel, points, velocity_points};
use crate::plot::{Colour, Figure, Series};
use crate::report::text_table;
use crate::simulation::{Run, RunSpec, all_estimators};
use crate::statistics::Spread;

/// The stretch of cruise that is shown close up, s.
const ZOOM_S: RangeInclusive<f64> = 1.0..=1.1;
const TICK_HZ: f64 = 1000.0;
const SEED: u64 = 1;
/// Where the plots go.
const FOLDER: &str = "target/leadscrew";

/// Runs the demonstration.
///
/// # Errors
/// A plot that cannot be written.
pub fn run() -> Result<(), CommandError> {
    let machine = MachineParams::z_16k20f3();
    let image = learn_simulated(&machine.encoder, SEED, &Procedure::default())
        .map_err(|error| CommandError::Data(error.to_string()))?;
    let map =
        EncoderMap::from_bytes(&image).map_err(|error| CommandError::Data(error.to_string()))?;
    let spec = |estimator| RunSpec {
        machine,
        scenario: MoveAndBack::standard(TICK_HZ),
        estimator,
        seed: SEED,
        map: Some(map),
    };
    let mut runs = Vec::new();
    for config in all_estimators() {
        runs.push((config.name(), spec(config).run()?));
    }
    // The data that all estimators are judged on: the run with exponential smoothing in the loop.
    let Some(judged) = runs
        .iter()
        .find(|(name, _)| *name == JUDGED)
        .map(|(_, run)| run)
    else {
        return Err(CommandError::Data(format!(
            "the estimator {JUDGED} is gone"
        )));
    };
    let errors: Vec<_> = runs
        .iter()
        .map(|(name, run)| (*name, run.following_error()))
        .collect();

    print(&format!(
        "{INTRODUCTION}{}\n{EXPLANATION}",
        table(judged, &errors).trim_fmt()
    ))?;
    for (name, figure) in [
        ("estimates", estimates_figure(judged)),
        ("zoom", zoom_figure(judged)),
        ("following-error", error_figure(&runs)),
    ] {
        for extension in ["svg", "png"] {
            save(&figure, &format!("{FOLDER}/{name}.{extension}"))?;
        }
    }
    Ok(())
}

const JUDGED: &str = "exponential";

const INTRODUCTION: &str = "\
Z axis of a 16K20F3 lathe, simulated: 300 mm at 9 000 mm/min and back, tick 1 ms
Encoder of 10 000 d/rev with errors of a real disc, drive with friction, delay;
its map learned from simulated runs of its own, in use from the first index on

";

const EXPLANATION: &str = "
d      one count of the encoder, 1 µm
rms    rms error over the move, ramps included, seed 1, against the truth at the
       instant it is for
tacho  rms difference from a tachogenerator read in steps of 0.233 d/tick
cut    how many times smaller than by plain differences: of rms a, of tacho
error  following error with that estimator in a loop that is tuned alike for all

";

fn table(run: &Run, errors: &[(&str, Spread)]) -> Table {
    let mut table = text_table(&[
        "estimator",
        "lag x/v/a\nticks",
        "rms v\nd/tick",
        "rms a\nd/tick²",
        "cut",
        "tacho\nd/tick",
        "cut",
        "error\npeak d",
        "error\nrms d",
    ]);
    let raw = run
        .listeners
        .first()
        .map(|listener| run.accuracy(listener))
        .unwrap_or_default();
    for listener in &run.listeners {
        let accuracy = run.accuracy(listener);
        let lags = listener.config.lags();
        let error = errors
            .iter()
            .find(|(name, _)| *name == listener.config.name())
            .map(|(_, error)| *error);
        let error = error.unwrap_or_default();
        table.add_row([
            listener.config.name().to_owned(),
            format!(
                "{:.2} {:.2} {:.2}",
                lags.position, lags.velocity, lags.acceleration
            ),
            format!("{:.4}", accuracy.velocity.rms()),
            format!("{:.4}", accuracy.acceleration.rms()),
            format!(
                "{:.1}",
                raw.acceleration.rms() / accuracy.acceleration.rms()
            ),
            format!("{:.4}", accuracy.against_tachogenerator.rms()),
            format!(
                "{:.1}",
                raw.against_tachogenerator.rms() / accuracy.against_tachogenerator.rms()
            ),
            format!("{:.1}", error.peak()),
            format!("{:.2}", error.rms()),
        ]);
    }
    table
}

/// Velocity, its error and acceleration by each method, and the truth.
fn estimates_figure(run: &Run) -> Figure {
    let truth = run.true_states();
    let (mut errors, mut accelerations) = (Vec::new(), Vec::new());
    for listener in &run.listeners {
        let name = listener.config.name();
        errors.push(estimator_series(name, run.velocity_errors(listener)));
        accelerations.push(estimator_series(
            name,
            acceleration_points(&listener.estimates, run.tick_hz),
        ));
    }
    let true_velocity = points(&truth, run.tick_hz, |_| 0.0, |state| state.velocity);
    let true_acceleration = points(&truth, run.tick_hz, |_| 0.0, |state| state.acceleration);
    accelerations.push(Series::dashed("true", true_acceleration, Colour::Black));
    let mut velocities = Vec::new();
    if let Some(listener) = run
        .listeners
        .iter()
        .find(|listener| listener.config.name() == JUDGED)
    {
        velocities.push(Series::line(
            JUDGED,
            velocity_points(&listener.estimates, run.tick_hz),
            Colour::Blue,
        ));
    }
    velocities.push(Series::dashed("true", true_velocity, Colour::Black));
    Figure::new(
        "16K20F3 Z: 300 mm at 9 000 mm/min and back, each estimate at the instant it is for",
        vec![
            panel(figures::VELOCITY, velocities),
            panel("velocity error, d/tick", errors),
            panel(figures::ACCELERATION, accelerations).with_y_limits(-2.2, 2.2),
        ],
    )
}

/// Velocity error and acceleration of each method in a stretch of cruise short enough to tell them apart.
fn zoom_figure(run: &Run) -> Figure {
    let shown = |points: Vec<(f64, f64)>| -> Vec<(f64, f64)> {
        points
            .into_iter()
            .filter(|(time, _)| ZOOM_S.contains(time))
            .collect()
    };
    let (mut errors, mut accelerations) = (Vec::new(), Vec::new());
    for listener in &run.listeners {
        let name = listener.config.name();
        let acceleration = acceleration_points(&listener.estimates, run.tick_hz);
        errors.push(estimator_series(name, shown(run.velocity_errors(listener))));
        accelerations.push(estimator_series(name, shown(acceleration)));
    }
    Figure::new(
        "16K20F3 Z: 0.1 s of the cruise; plain differences go on beyond the frame",
        vec![
            panel("velocity error, d/tick", errors).with_y_limits(-0.4, 0.4),
            panel(figures::ACCELERATION, accelerations).with_y_limits(-0.3, 0.3),
        ],
    )
}

/// Following error with each estimator in the loop.
fn error_figure(runs: &[(&str, Run)]) -> Figure {
    let series = runs.iter().map(|(name, run)| {
        let error = points(
            &run.ticks,
            run.tick_hz,
            |_| 0.0,
            |tick| tick.outputs.following_error.to_num(),
        );
        estimator_series(name, error)
    });
    Figure::new(
        "16K20F3 Z: following error with each estimator in the loop",
        vec![panel(figures::FOLLOWING_ERROR, series.collect())],
    )
}

fn save(figure: &Figure, path: &str) -> Result<(), CommandError> {
    std::fs::create_dir_all(FOLDER).map_err(CommandError::write(Path::new(FOLDER)))?;
    figure.save(Path::new(path))?;
    print(&format!("{path}\n"))
}
