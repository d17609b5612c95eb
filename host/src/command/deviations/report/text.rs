//! The report for people.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use leadscrew_nc::coordinates::Axis;

use super::{Indicators, Place, Report, Vector};
use crate::report::{decimals, text_table};

impl Report {
    /// The report for people.
    pub fn to_text(&self) -> String {
        let drive_errors = match self.drive_errors {
            "included" => "the drives' own errors included: no screw map besides",
            _ => "without the drives' own errors: a screw map corrects them elsewhere",
        };
        let [x, y, z] = self.tool_mm;
        let mut text = format!(
            "{}, {}\n{drive_errors}\ntool's tip {x} {y} {z} mm from its unit\n",
            self.machine, self.origin
        );
        for one in &self.indicators {
            text += &one.to_text();
        }
        match &self.at {
            Some(place) => text += &self.place_text(place),
            None => text += &self.volume_text(),
        }
        if !self.map.is_empty() {
            text += &map_text(&self.map);
        }
        if let Some(um) = self.corrections_error_um {
            // Writing to a text cannot fail.
            let _ = writeln!(
                text,
                "\nthe table of corrections is within {um:.2} um of K between its nodes"
            );
        }
        text
    }

    fn place_text(&self, place: &Place) -> String {
        let mut table = text_table(&[
            "unit", "chain", "a um", "b um", "c um", "λ urad", "β urad", "γ urad", "Δx um",
            "Δy um", "Δz um",
        ]);
        for row in &self.units {
            let mut cells = vec![row.unit.clone(), row.chain.to_owned()];
            cells.extend(row.setting.um.map(|um| decimals(um, 2)));
            cells.extend(row.setting.urad.map(|urad| decimals(urad, 1)));
            cells.extend(row.part.um.map(|um| decimals(um, 2)));
            table.add_row(cells);
        }
        let Place {
            machine,
            deviation,
            correction,
            left,
        } = place;
        format!(
            "\nat {}\n{}\n\nΔ     {}\nK     {}\nleft  {}\n",
            listed(machine, 3),
            table.trim_fmt(),
            deviation.to_text(),
            listed_signed(correction),
            left.to_text(),
        )
    }

    fn volume_text(&self) -> String {
        let mut table = text_table(&["largest", "value", "unit", "at"]);
        if let Some(column) = table.column_mut(3) {
            column.set_cell_alignment(comfy_table::CellAlignment::Left);
        }
        for one in &self.largest {
            table.add_row([
                one.what.to_owned(),
                decimals(one.value, 2),
                one.unit.to_owned(),
                listed(&one.at, 1),
            ]);
        }
        let ends = self
            .volume
            .iter()
            .map(|(axis, [low, high])| format!("{axis} {low} to {high}"));
        format!(
            "\n{} places over {}\n{}\n",
            self.places,
            ends.collect::<Vec<_>>().join(", "),
            table.trim_fmt()
        )
    }
}

impl Indicators {
    fn to_text(&self) -> String {
        let sigma = self.sigma.iter().map(|(component, sigma)| {
            let sigma = sigma.map_or_else(|| "-".to_owned(), |sigma| decimals(sigma, 2));
            format!("{component} {sigma}")
        });
        format!(
            "{} from indicators: 1σ {} (um, urad){}\n",
            self.unit,
            sigma.collect::<Vec<_>>().join(", "),
            self.largest_residual_um.map_or_else(String::new, |um| {
                format!(", largest residual {} um", decimals(um, 2))
            })
        )
    }
}

impl Vector {
    fn to_text(&self) -> String {
        let [x, y, z] = self.um.map(|um| decimals(um, 2));
        let [lambda, beta, gamma] = self.urad.map(|urad| decimals(urad, 1));
        format!("x {x}, y {y}, z {z} um; λ {lambda}, β {beta}, γ {gamma} urad")
    }
}

fn map_text(map: &[Place]) -> String {
    let Some(first) = map.first() else {
        return String::new();
    };
    let axes = first.machine.keys().map(ToString::to_string);
    let corrected = first
        .correction
        .keys()
        .map(|axis| format!("K{axis} {}", if axis.is_rotary() { "deg" } else { "um" }));
    let delta = ["Δx um", "Δy um", "Δz um", "λ urad", "β urad", "γ urad"].map(str::to_owned);
    let header: Vec<String> = axes.chain(delta).chain(corrected).collect();
    let mut table = text_table(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for row in map {
        let places = row.machine.values().map(|value| decimals(*value, 1));
        let um = row.deviation.um.iter().map(|um| decimals(*um, 2));
        let urad = row.deviation.urad.iter().map(|urad| decimals(*urad, 1));
        let k = row
            .correction
            .iter()
            .map(|(axis, k)| match axis.is_rotary() {
                true => decimals(*k, 5),
                false => decimals(1e3 * k, 2),
            });
        table.add_row(places.chain(um).chain(urad).chain(k).collect::<Vec<_>>());
    }
    format!("\n{}\n", table.trim_fmt())
}

fn listed(places: &BTreeMap<Axis, f64>, digits: usize) -> String {
    let one = places
        .iter()
        .map(|(axis, value)| format!("{axis} {}", decimals(*value, digits)));
    one.collect::<Vec<_>>().join(" ")
}

/// Corrections in µm, and degrees for rotary axes.
fn listed_signed(correction: &BTreeMap<Axis, f64>) -> String {
    let one = correction.iter().map(|(axis, k)| match axis.is_rotary() {
        true => format!("{axis} {} deg", decimals(*k, 5)),
        false => format!("{axis} {} um", decimals(1e3 * k, 2)),
    });
    one.collect::<Vec<_>>().join(", ")
}
