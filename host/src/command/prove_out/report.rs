//! Figures of the part before and after, for people and programs.

use std::fmt::Write as _;

use leadscrew_process::prove_out::{Feature, ProveOut, Row, SIGMAS};
use serde::Serialize;

use crate::report::{decimals, text_table};

/// The report.
#[derive(Serialize)]
pub(super) struct Report {
    schema: &'static str,
    seed: u64,
    probe_2s_um: f64,
    touches: usize,
    /// The figures of the features.
    figures: Vec<FigureRow>,
    /// Where the part lies, as computed and as it should have been seen: mm and rad.
    setting: Setting,
    /// What each tool cuts beside its place, mm.
    tools: Vec<Tool>,
    /// Every figure is within its bound.
    holds: bool,
}

/// A figure in µm or µrad.
#[derive(Serialize)]
struct FigureRow {
    figure: String,
    unit: &'static str,
    /// In truth, after the first pass.
    before: f64,
    probed_before: f64,
    /// As the machine reads it that is told nothing.
    unaware_before: f64,
    /// In truth, after the corrected program.
    after: f64,
    bound: f64,
    probed_after: f64,
    probed_bound: f64,
}

#[derive(Serialize)]
struct Setting {
    found: [f64; 6],
    truth: [f64; 6],
}

#[derive(Serialize)]
struct Tool {
    tool: u32,
    /// 0 along axes that none of its features looks along.
    found_mm: [f64; 3],
    truth_mm: [f64; 3],
}

impl Report {
    pub fn new(seed: u64, probe_um: f64, out: &ProveOut) -> Self {
        let tool = |(tool, truth): (&u32, &[f64; 3])| Tool {
            tool: *tool,
            found_mm: out
                .found
                .tools
                .get(tool)
                .map_or([0.0; 3], |beside| beside.mm),
            truth_mm: *truth,
        };
        Self {
            schema: "leadscrew/prove-out/1",
            seed,
            probe_2s_um: probe_um,
            touches: out.touches,
            figures: out.rows.iter().map(FigureRow::of).collect(),
            setting: Setting {
                found: out.found.setting.to_array(),
                truth: out.setting_seen.to_array(),
            },
            tools: out.tools_seen.iter().map(tool).collect(),
            holds: out.holds(),
        }
    }

    /// The report for people.
    pub fn to_text(&self) -> String {
        let mut table = text_table(&[
            "figure\n",
            "unit\n",
            "before\nin truth",
            "before\nprobed",
            "before\nunaware",
            "after\nin truth",
            "bound\nof it",
            "after\nprobed",
            "bound\nof it",
        ]);
        for row in &self.figures {
            let values = [
                row.before,
                row.probed_before,
                row.unaware_before,
                row.after,
                row.bound,
                row.probed_after,
                row.probed_bound,
            ];
            let cells = [row.figure.clone(), row.unit.to_owned()];
            table.add_row(
                cells
                    .into_iter()
                    .chain(values.map(|value| decimals(value, 2))),
            );
        }
        let mut text = format!(
            "seed {}, {} touches of a probe of 2σ = {} um\n\n{}\n\n\
             unaware: as the machine reads where it cut, told neither its deviations nor where the part lies\n\
             bound: {SIGMAS} σ of setting, tools and map{}\n\n",
            self.seed,
            self.touches,
            self.probe_2s_um,
            table.trim_fmt(),
            if self.holds {
                "; all figures are within"
            } else {
                "; NOT all figures are within"
            },
        );
        let scaled = |values: &[f64; 6]| {
            let values = values.iter().map(|value| format!("{value:.6}"));
            values.collect::<Vec<_>>().join(" ")
        };
        // Writing to a text cannot fail.
        let _ = writeln!(text, "setting of the part a b c mm, λ β γ rad");
        let _ = writeln!(text, "  found {}", scaled(&self.setting.found));
        let _ = writeln!(text, "  truth {}", scaled(&self.setting.truth));
        for tool in &self.tools {
            let list = |values: &[f64; 3]| {
                let values = values.iter().zip(&tool.found_mm);
                let text = values.map(|(value, found)| match *found {
                    0.0 => "-".to_owned(),
                    _ => format!("{value:.4}"),
                });
                text.collect::<Vec<_>>().join(" ")
            };
            let _ = writeln!(
                text,
                "tool {} cuts beside by x y z mm: found {}, truth {}",
                tool.tool,
                list(&tool.found_mm),
                list(&tool.truth_mm)
            );
        }
        text
    }
}

impl FigureRow {
    fn of(row: &Row) -> Self {
        let (scale, unit) = if row.is_angle {
            (1e6, "urad")
        } else {
            (1e3, "um")
        };
        Self {
            figure: format!("{} {}", feature(row.feature), row.what),
            unit,
            before: scale * row.before,
            probed_before: scale * row.probed_before,
            unaware_before: scale * row.blind_before,
            after: scale * row.after,
            bound: scale * row.bound,
            probed_after: scale * row.probed_after,
            probed_bound: scale * row.probed_bound,
        }
    }
}

fn feature(feature: Feature) -> String {
    match feature {
        Feature::Bore(number) => format!("bore {}", number + 1),
        one => format!("{one:?}").to_lowercase(),
    }
}
