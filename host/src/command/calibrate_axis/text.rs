//! The report for people.

use std::fmt::Write;

use leadscrew_process::axis_calibration::{Calibration, Uncertainty};

use super::Report;
use crate::report::{decimals, text_table};

pub(super) fn of(report: &Report<'_>, pitch: Option<f64>) -> String {
    let calibration = report.calibration;
    let mut text = format!(
        "{}: {} targets over {} mm, {} runs each way, reduced to 20 °C by {} µm/(m·K)\n\n{}\n\n{}\n",
        report.file,
        calibration.targets.len(),
        calibration.length_mm,
        calibration.runs,
        report.expansion.machine_um_per_m_k - report.expansion.instrument_um_per_m_k,
        targets(calibration),
        figures(calibration, &report.uncertainty),
    );
    text += &sources(&report.uncertainty);
    if let Some(alias) = &report.alias {
        let _ = writeln!(text, "warning: {alias}");
    }
    if pitch.is_none() {
        text += "note: whether the targets lie at multiples of the pitch was not looked at: tell it by --pitch\n";
    }
    if !report.is_after_the_standard {
        text += "note: --accept-few: fewer runs or targets than ISO 230-2 asks for may be in it\n";
    }
    text
}

fn targets(calibration: &Calibration) -> String {
    let mut table = text_table(&[
        "target\nmm",
        "mean up\nµm",
        "mean down\nµm",
        "s up\nµm",
        "s down\nµm",
        "reversal B\nµm",
        "R up\nµm",
        "R down\nµm",
        "R\nµm",
    ]);
    for target in &calibration.targets {
        let [up, down] = target.mean_um;
        let [s_up, s_down] = target.s_um;
        let [r_up, r_down] = target.repeatability_one_way_um;
        let figures = [
            up,
            down,
            s_up,
            s_down,
            target.reversal_um,
            r_up,
            r_down,
            target.repeatability_um,
        ];
        let mut row = vec![format!("{:.3}", target.target_mm)];
        row.extend(figures.map(um));
        table.add_row(row);
    }
    table.trim_fmt()
}

fn figures(calibration: &Calibration, uncertainty: &Uncertainty) -> String {
    let axis = &calibration.axis;
    let mut table = text_table(&["of the axis, µm", "both ways", "up", "down", "U (k = 2)"]);
    let mut row = |name: &str, both: f64, one_way: Option<[f64; 2]>, uncertainty: f64| {
        let [up, down] = one_way.map_or(["-".to_owned(), "-".to_owned()], |pair| pair.map(um));
        // Where no source of it was told there is none, not one of 0.
        let uncertainty = if uncertainty > 0.0 {
            um(uncertainty)
        } else {
            "-".to_owned()
        };
        table.add_row([name.to_owned(), um(both), up, down, uncertainty]);
    };
    row(
        "reversal B",
        axis.reversal_um,
        None,
        uncertainty.reversal_um,
    );
    row(
        "mean reversal",
        axis.mean_reversal_um,
        None,
        uncertainty.reversal_um,
    );
    row(
        "repeatability R",
        axis.repeatability_um,
        Some(axis.repeatability_one_way_um),
        uncertainty.repeatability_um,
    );
    row(
        "systematic error E",
        axis.systematic_um,
        Some(axis.systematic_one_way_um),
        uncertainty.systematic_um,
    );
    row(
        "range of means M",
        axis.mean_range_um,
        None,
        uncertainty.mean_range_um,
    );
    row(
        "accuracy A",
        axis.accuracy_um,
        Some(axis.accuracy_one_way_um),
        uncertainty.accuracy_um,
    );
    table.trim_fmt()
}

fn sources(uncertainty: &Uncertainty) -> String {
    let Uncertainty {
        device_um,
        alignment_um,
        thermometer_um,
        expansion_um,
        drift_um,
        ..
    } = uncertainty;
    if uncertainty.accuracy_um == 0.0 {
        return "note: no uncertainty of the measurement was told (--device, --misalignment, --thermometer, --expansion-range, \
                --drift)\n"
            .to_owned();
    }
    format!(
        "uncertainty (k = 2), µm: instrument {device_um:.2}, alignment {alignment_um:.2}, thermometer {thermometer_um:.2}, \
         expansion {expansion_um:.2}, drift {drift_um:.2}\n"
    )
}

/// With two decimals.
fn um(value: f64) -> String {
    decimals(value, 2)
}
