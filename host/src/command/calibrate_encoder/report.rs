//! Figures of a calibration, for people and programs.

use std::fmt::Write;

use leadscrew::calibration::{Bands, NOT_SEPARATED, RunSummary};
use serde::Serialize;

use crate::calibration::{Calibration, RunFigures, Stretch};
use crate::cli::CalibrateEncoderArgs;
use crate::report::{figure_or_dash, text_table};

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

impl Waves {
    const NAMES: [&'static str; 6] = [
        "once a revolution",
        "twice",
        "3 to 10 times",
        "11 to 32 times",
        "shorter, line by line",
        "edges within a line",
    ];

    const fn figures(&self) -> [f64; 6] {
        [
            self.first,
            self.second,
            self.third_to_tenth,
            self.eleventh_to_32nd,
            self.lines,
            self.edges,
        ]
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
            let at = |tick: u64| tick as f64 / args.tick_hz;
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
            map: args.out.display().to_string(),
            map_bytes: calibration.image.len(),
            edges_per_rev: args.edges_per_rev,
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

    /// The report for people.
    pub(super) fn to_text(&self) -> String {
        let mut text = format!(
            "{}: {} bytes, {} edges a revolution, {}\n\n{}\n\n{}\n\n",
            self.map,
            self.map_bytes,
            self.edges_per_rev,
            self.form,
            self.run_table(),
            self.wave_table()
        );
        self.write_findings(&mut text);
        text
    }

    fn run_table(&self) -> String {
        let mut table = text_table(&[
            "run",
            "from\ns",
            "to\ns",
            "direction\n",
            "speed\nd/tick",
            "speed\nrpm",
            "revolutions\naveraged",
            "noise\nof a pass, d",
            "file\n",
        ]);
        for (number, run) in (1..).zip(&self.runs) {
            table.add_row([
                format!("{number}"),
                format!("{:.2}", run.from_s),
                format!("{:.2}", run.to_s),
                run.direction.to_owned(),
                format!("{:.2}", run.speed),
                format!("{:.1}", run.rpm),
                format!("{}", run.revolutions),
                format!("{:.4}", run.pass_noise),
                run.file.clone(),
            ]);
        }
        table.trim_fmt()
    }

    fn wave_table(&self) -> String {
        let mut table = text_table(&[
            "errors, d rms",
            "without\na map",
            "left on the last run\nby a map of the others",
            "halves of it\nagainst each other",
        ]);
        let halves = self.runs.last().map(|run| run.halves.figures());
        let after = self.errors_after.map(|after| after.figures());
        for (row, (name, before)) in Waves::NAMES
            .iter()
            .zip(self.errors_before.figures())
            .enumerate()
        {
            table.add_row([
                (*name).to_owned(),
                format!("{before:.4}"),
                figure_or_dash(after.map(|after| after[row]), 4),
                // Halves are compared in long waves.
                figure_or_dash(halves.map(|halves| halves[row]).filter(|_| row < 4), 4),
            ]);
        }
        table.trim_fmt()
    }

    fn write_findings(&self, text: &mut String) {
        // Writing to a string does not fail.
        let mut put = |line: String| {
            let _ = writeln!(text, "{line}");
        };
        for (name, phases) in [
            ("forward", self.phases.forward),
            ("backward", self.phases.backward),
        ] {
            match phases {
                Some([first, second, third, fourth]) => put(format!(
                    "phases {name}: {first:.4} {second:.4} {third:.4} {fourth:.4} d"
                )),
                None => put(format!(
                    "phases {name}: no run, taken from the other direction"
                )),
            }
        }
        if let Some(hysteresis) = self.hysteresis_a_less_b {
            put(format!(
                "hysteresis of A less that of B: {hysteresis:.4} d; what both have in common cannot be seen"
            ));
        }
        if let Some(found) = &self.disagreement {
            put(format!(
                "runs disagree most at {} cycles a revolution: run {} by {:.4} d",
                found.cycles_per_rev, found.run, found.difference
            ));
        }
        let residual = &self.residual;
        put(format!(
            "the map leaves: edges {:.4} d, slope {:.1e} d/d, curvature {:.1e} 1/d; noise of a pass {:.4} d and {:.0} ns",
            residual.edges,
            residual.slope,
            residual.curvature,
            residual.noise_place,
            1e9 * residual.noise_time
        ));
        for left in &self.not_used {
            put(format!(
                "not used: {:.1} revolutions from {:.2} to {:.2} s of {}: {}",
                left.revolutions, left.from_s, left.to_s, left.file, left.why
            ));
        }
        put(format!("note: {}", self.not_separated));
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
            speed: summary.speed_d_s / args.tick_hz,
            rpm: 60.0 * summary.speed_d_s / f64::from(args.edges_per_rev),
            revolutions: summary.revolutions,
            pass_noise: summary.pass_sigma_d,
            errors: summary.errors.into(),
            less_runs_before: summary.less_earlier_runs.map(Waves::from),
            halves: summary.halves.into(),
        }
    }
}
