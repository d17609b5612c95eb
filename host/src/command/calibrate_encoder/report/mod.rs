//! Figures of a calibration, for people and programs.

mod text;

use std::path::Path;

use leadscrew::calibration::{Bands, NOT_SEPARATED, RunSummary};
use serde::Serialize;

use crate::calibration::{Calibration, RunFigures, Stretch};
use crate::cli::CalibrateEncoderArgs;

/// The report of a calibration.
#[derive(Serialize)]
pub(super) struct Report {
    schema: &'static str,
    map: String,
    map_bytes: usize,
    edges_per_rev: u32,
    form: &'static str,
    units: Units,
    runs: Vec<Run>,
    not_used: Vec<NotUsed>,
    /// Errors of the encoder without a map.
    errors_before: Waves,
    /// What a map of the other runs leaves on the last run; null for a single run and without index.
    errors_after: Option<Waves>,
    phases: Phases,
    hysteresis_a_less_b: Option<f64>,
    disagreement: Option<Disagreement>,
    residual: Residual,
    not_separated: &'static str,
}

#[derive(Serialize)]
struct Units {
    errors: &'static str,
    speed: &'static str,
    slope: &'static str,
    curvature: &'static str,
    noise_time: &'static str,
}

#[derive(Serialize)]
struct Run {
    file: String,
    from_s: f64,
    to_s: f64,
    direction: &'static str,
    speed: f64,
    rpm: f64,
    /// Revolutions in the average.
    revolutions: u32,
    /// Noise of one pass of an edge.
    pass_noise: f64,
    errors: Waves,
    /// What a map of the runs before leaves.
    less_runs_before: Option<Waves>,
    /// Second half less first half.
    halves: Waves,
}

#[derive(Serialize)]
struct NotUsed {
    file: String,
    from_s: f64,
    to_s: f64,
    revolutions: f64,
    why: &'static str,
}

/// Errors by wavelength, d rms.
#[derive(Clone, Copy, Serialize)]
struct Waves {
    #[serde(rename = "1_per_rev")]
    first: f64,
    #[serde(rename = "2_per_rev")]
    second: f64,
    #[serde(rename = "3_to_10_per_rev")]
    third_to_tenth: f64,
    #[serde(rename = "11_to_32_per_rev")]
    eleventh_to_32nd: f64,
    lines: f64,
    edges: f64,
}

#[derive(Serialize)]
struct Phases {
    forward: Option<[f64; 4]>,
    backward: Option<[f64; 4]>,
}

#[derive(Serialize)]
struct Disagreement {
    cycles_per_rev: u32,
    difference: f64,
    /// Number of the run, from 1.
    run: usize,
}

#[derive(Serialize)]
struct Residual {
    edges: f32,
    slope: f32,
    curvature: f32,
    noise_place: f32,
    noise_time: f32,
}

impl From<Bands> for Waves {
    fn from(bands: Bands) -> Self {
        Self {
            first: bands.first,
            second: bands.second,
            third_to_tenth: bands.third_to_tenth,
            eleventh_to_32nd: bands.eleventh_to_32nd,
            lines: bands.lines,
            edges: bands.edges,
        }
    }
}

impl Report {
    /// The report of a calibration that was asked for by `args`.
    pub(super) fn new(calibration: &Calibration, args: &CalibrateEncoderArgs) -> Self {
        let file = |recording: usize| {
            let file = args.files.get(recording);
            file.map_or_else(String::new, |file| file.display().to_string())
        };
        let seconds = |stretch: &Stretch| {
            let at = |tick: u64| tick as f64 / args.rate.tick_hz;
            (at(stretch.from), at(stretch.to))
        };
        let run = |run: &RunFigures| {
            let (from_s, to_s) = seconds(&run.stretch);
            Run::new(&run.summary, file(run.recording), (from_s, to_s), args)
        };
        let not_used = calibration.left.iter().map(|left| {
            let (from_s, to_s) = seconds(&left.stretch);
            NotUsed {
                file: file(left.recording),
                from_s,
                to_s,
                revolutions: left.stretch.revolutions,
                why: if left.enough {
                    "longer ones were used"
                } else {
                    "too short"
                },
            }
        });
        let last = calibration.runs.last();
        let after = last.and_then(|run| run.summary.less_earlier_runs);
        let [forward, backward] = calibration.phases_d;
        let residual = &calibration.residual;
        Self {
            schema: "leadscrew/calibrate-encoder/1",
            map: args
                .out
                .as_deref()
                .unwrap_or(Path::new(""))
                .display()
                .to_string(),
            map_bytes: calibration.image.len(),
            edges_per_rev: args.edges_per_rev.unwrap_or_default(),
            form: match args.form {
                crate::cli::MapForm::Full => "full",
                crate::cli::MapForm::Coarse => "coarse",
                crate::cli::MapForm::Phases => "phases",
            },
            units: Units {
                errors: "d rms",
                speed: "d/tick",
                slope: "d/d",
                curvature: "1/d",
                noise_time: "s",
            },
            runs: calibration.runs.iter().map(run).collect(),
            not_used: not_used.collect(),
            errors_before: calibration.errors.into(),
            errors_after: after.map(Waves::from),
            phases: Phases { forward, backward },
            hysteresis_a_less_b: calibration.hysteresis_a_less_b_d,
            disagreement: calibration.disagreement.map(|found| Disagreement {
                cycles_per_rev: found.order,
                difference: found.difference_d,
                run: found.run + 1,
            }),
            residual: Residual {
                edges: residual.short_wave_d,
                slope: residual.slope,
                curvature: residual.curvature_per_d,
                noise_place: residual.noise_d,
                noise_time: residual.noise_s,
            },
            not_separated: NOT_SEPARATED,
        }
    }
}

impl Run {
    fn new(
        summary: &RunSummary,
        file: String,
        (from_s, to_s): (f64, f64),
        args: &CalibrateEncoderArgs,
    ) -> Self {
        Self {
            file,
            from_s,
            to_s,
            direction: if summary.backward {
                "backward"
            } else {
                "forward"
            },
            speed: summary.speed_d_s / args.rate.tick_hz,
            rpm: 60.0 * summary.speed_d_s / f64::from(args.edges_per_rev.unwrap_or(1)),
            revolutions: summary.revolutions,
            pass_noise: summary.pass_sigma_d,
            errors: summary.errors.into(),
            less_runs_before: summary.less_earlier_runs.map(Waves::from),
            halves: summary.halves.into(),
        }
    }
}
