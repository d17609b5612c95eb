//! The setup: everything about the control, the machine and its deviations that a program does not say, in one TOML file.

mod owner;
mod terms;

use serde::Deserialize;
use toml::Spanned;

use crate::checks::{within, within_at};
use crate::coordinates::AxisSet;
use crate::dialect::Dialect;
use crate::machine_state::MachineState;
use crate::path::Tolerance;
use crate::source::{Complaint, Place, read_toml, span_of};
use crate::terms::Terms;

pub use owner::Owner;

/// Finest and coarsest tolerance that is believed, mm or degrees.
const TOLERANCES: (f64, f64) = (1e-5, 1.0);

/// Largest radius of a tool that is believed, mm.
const LARGEST_RADIUS_MM: f64 = 1000.0;
/// The table of the machine's state.
pub(crate) const CONTROL: &str = "control";

/// What a correction needs to know besides the program.
#[derive(Debug)]
pub struct Setup {
    /// The dialect, where the file names it.
    pub dialect: Option<Dialect>,
    /// What the control knows.
    pub control: MachineState,
    /// What is corrected.
    pub terms: Terms,
    /// How far the written path may be from the truly corrected one.
    pub tolerance: Tolerance,
    /// Where each term is in the file, and what it corrects.
    places: Vec<(String, Place, AxisSet)>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SetupFile {
    dialect: Option<Spanned<String>>,
    tolerance_mm: Option<Spanned<f64>>,
    tolerance_deg: Option<Spanned<f64>>,
    screw_map: Option<Spanned<owner::OwnerFile>>,
    #[serde(default)]
    control: MachineState,
    #[serde(default)]
    terms: terms::TermsFile,
}

/// Gives the text of a file that the setup names, relative to the setup; else why there is none.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> Result<String, String>;

impl Setup {
    /// From the text of a setup file.
    ///
    /// # Errors
    /// What is wrong in it or in a file that it names, and where.
    pub fn read(text: &str, files: ReadFile<'_>) -> Result<Self, Complaint> {
        let file: SetupFile = read_toml(text)?;
        let dialect = file
            .dialect
            .as_ref()
            .map(|name| named_dialect(text, name, files))
            .transpose()?;
        let tolerance = |key, value: &Option<Spanned<f64>>, unit, default| match value {
            Some(value) => within(text, key, value, TOLERANCES, unit),
            None => Ok(default),
        };
        let tolerance = Tolerance {
            mm: tolerance("tolerance_mm", &file.tolerance_mm, "mm", 0.001)?,
            degrees: tolerance("tolerance_deg", &file.tolerance_deg, "deg", 0.001)?,
        };
        let control = control(text, file.control)?;
        let built = terms::build(text, &file.terms, files)?;
        owner::check(text, file.screw_map.as_ref(), &built)?;
        let mut setup = Self {
            dialect,
            control,
            terms: Terms::none(),
            tolerance,
            places: Vec::new(),
        };
        for one in built {
            let place = Place::of(text, one.span.start);
            let name = one.term.name().to_owned();
            setup.places.push((name, place, one.term.corrects()));
            setup.terms.push(one.term);
        }
        Ok(setup)
    }

    /// Refuses terms that correct axes which the dialect has not.
    ///
    /// # Errors
    /// The first such term, at its place in the file.
    pub fn check_axes(&self, dialect: &Dialect) -> Result<(), Complaint> {
        for (name, place, corrects) in &self.places {
            if let Some(axis) = corrects.iter().find(|axis| !dialect.axes().contains(*axis)) {
                return Err(Complaint {
                    place: *place,
                    message: format!(
                        "term \"{name}\" corrects {axis}, which dialect {} has not: its axes are {}",
                        dialect.name(),
                        dialect.axes()
                    ),
                });
            }
        }
        Ok(())
    }
}

/// A dialect by its name, or from a file, whose name ends in `.toml`.
fn named_dialect(
    text: &str,
    name: &Spanned<String>,
    files: ReadFile<'_>,
) -> Result<Dialect, Complaint> {
    let complain = |message: String| Complaint::at(text, &name.span(), message);
    let known = name.get_ref();
    if known.ends_with(".toml") {
        let content = files(known).map_err(complain)?;
        return Dialect::from_toml(&content)
            .map_err(|complaint| complain(format!("{known}:{complaint}")));
    }
    Dialect::named(known).ok_or_else(|| {
        let names: Vec<_> = Dialect::names().collect();
        complain(format!(
            "dialect = \"{known}\" is not known: expected one of {}, or a file NAME.toml",
            names.join(", ")
        ))
    })
}

/// The machine's state, its numbers checked.
fn control(text: &str, state: MachineState) -> Result<MachineState, Complaint> {
    let far = crate::checks::FARTHEST;
    for (key, places) in state.all_places() {
        for (axis, value) in places {
            let letter = axis.letter().to_string();
            let path: Vec<&str> = key.iter().map(String::as_str).chain([&*letter]).collect();
            in_control(text, &path, &letter, *value, (-far, far), axis.unit())?;
        }
    }
    for (number, tool) in &state.tools {
        if let Some(radius) = tool.radius_mm {
            let path = ["tools", &number.to_string(), "radius_mm"];
            in_control(
                text,
                &path,
                "radius_mm",
                radius,
                (0.0, LARGEST_RADIUS_MM),
                "mm",
            )?;
        }
    }
    if let Some(radius) = state.radius_tolerance_mm {
        let key = "radius_tolerance_mm";
        in_control(text, &[key], key, radius, (0.0, 1.0), "mm")?;
    }
    Ok(state)
}

/// A number under `control` within bounds.
fn in_control(
    text: &str,
    path: &[&str],
    key: &str,
    number: f64,
    range: (f64, f64),
    unit: &str,
) -> Result<(), Complaint> {
    let path: Vec<&str> = [CONTROL].iter().chain(path).copied().collect();
    let key = format!("{CONTROL}: {key}");
    within_at(text, &span_of(text, &path), &key, number, range, unit).map(|_| ())
}
