//! The report for people.

use std::fmt::Write;

use leadscrew_process::metrology::part::report::{FeatureReport, Report, Value};

use crate::report::{decimals, text_table};

/// A table of values, one of touches where any is flagged, and the notes.
pub fn report(report: &Report) -> String {
    let mut text = format!("{}\n", values(report));
    text += &outliers(report);
    for feature in &report.features {
        for note in &feature.notes {
            let _ = writeln!(text, "{}: {note}", feature.name);
        }
    }
    text
}

fn values(report: &Report) -> String {
    let mut table = text_table(&["feature", "", "value", "1σ", "unit", "touches", "1σ from"]);
    // Names read from the left.
    if let Some(quantities) = table.column_mut(1) {
        quantities.set_cell_alignment(comfy_table::CellAlignment::Left);
    }
    for feature in &report.features {
        let mut head = format!("{} ({})", feature.name, feature.kind);
        let (mut touches, mut from) = touches(feature);
        for value in &feature.values {
            let (number, sigma, unit) = shown(value);
            let touches = std::mem::take(&mut touches);
            let from = std::mem::take(&mut from);
            let row = [
                std::mem::take(&mut head),
                value.quantity.clone(),
                number,
                sigma,
                unit.to_owned(),
                touches,
                from,
            ];
            table.add_row(row);
        }
    }
    table.trim_fmt()
}

/// Number of touches and unknowns, and where the 1σ comes from.
fn touches(feature: &FeatureReport) -> (String, String) {
    let count = match feature.touches.len() {
        0 => String::new(),
        count => count.to_string(),
    };
    let from = feature
        .sigma_from
        .map_or_else(String::new, |from| match feature.over_stated {
            Some(ratio) => format!("{}, rms {ratio:.2} of stated", from.name()),
            None => from.name().to_owned(),
        });
    (count, from)
}

/// Lengths to 0.1 µm, angles in µrad to 0.1.
fn shown(value: &Value) -> (String, String, &'static str) {
    let (factor, digits, unit) = match value.unit {
        "rad" => (1e6, 1, "µrad"),
        "mm/mm" => (1e3, 4, "µm/mm"),
        "" => (1.0, 0, ""),
        unit => (1.0, 4, unit),
    };
    let show = |number: f64| decimals(number * factor, digits);
    let sigma = value.sigma.map_or_else(|| "-".to_owned(), show);
    (show(value.value), sigma, unit)
}

/// Touches that do not fit; nothing if all do.
fn outliers(report: &Report) -> String {
    let mut table = text_table(&["flagged touch", "residual mm", "over its 1σ", ""]);
    let mut any = false;
    for feature in &report.features {
        for touch in feature.touches.iter().filter(|touch| touch.is_outlier) {
            any = true;
            let over = touch
                .standardised
                .map_or_else(|| "-".to_owned(), |over| format!("{over:.1}"));
            let fate = if touch.is_left_out {
                "left out"
            } else {
                "counts: --without-outliers leaves it out"
            };
            let name = format!("{}/{}", feature.name, touch.point);
            table.add_row([
                name,
                format!("{:.4}", touch.residual_mm),
                over,
                fate.to_owned(),
            ]);
        }
    }
    if any {
        format!("\n{}\n", table.trim_fmt())
    } else {
        String::new()
    }
}
