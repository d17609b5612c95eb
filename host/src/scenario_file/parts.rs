//! Machine, axis and encoder of a scenario.

use std::path::Path;

use leadscrew::estimator::{EstimatorConfig, difference};
use leadscrew::parameter_table::ParameterTable;
use leadscrew::params::{AxisParams, SectionVisitor};
use leadscrew_hal_mock::scenario::{
    BANDWIDTH_RAD_PER_S, BOARD_SECTIONS, Base, MACHINE_SECTIONS, Plant, Setting, Tuning, Visitor,
    visit_axis, visit_plant,
};
use toml::de::{DeTable, DeValue};

use super::words::{Key, Value, read_all};
use crate::machine_file;
use crate::toml_file::{Complaint, fill, suggestion};

/// `[machine]`.
#[derive(Default)]
pub struct MachinePart {
    pub base: Base,
    pub settings: Vec<Setting>,
}

impl MachinePart {
    pub fn read(table: Option<&DeTable<'_>>, scenario: &Path) -> Result<Self, Complaint> {
        let Some(table) = table else {
            return Ok(Self::default());
        };
        let base = machine_file::base(table)?;
        let mut plant = match table.get("file") {
            None => Plant::from(base.params()),
            Some(value) => {
                let Some(name) = value
                    .get_ref()
                    .as_str()
                    .filter(|_| table.get("base").is_none())
                else {
                    return Err(Complaint::new(
                        value.span(),
                        "file must be the name of a machine file in quotes, and stand without base",
                    ));
                };
                let path = scenario.parent().unwrap_or(Path::new("")).join(name);
                let read = machine_file::read(&path);
                Plant::from(read.map_err(|error| Complaint::new(value.span(), error.to_string()))?)
            }
        };
        let sections = plant_sections();
        machine_file::fill_sections(table, &sections, &["base", "file"], |section, fill| {
            visit_plant(&mut plant, section, fill)
        })?;
        Ok(Self {
            base,
            settings: differences(base, &mut plant),
        })
    }
}

fn plant_sections() -> Vec<&'static str> {
    [MACHINE_SECTIONS, BOARD_SECTIONS].concat()
}

/// What makes `plant` of `base`.
fn differences(base: Base, plant: &mut Plant) -> Vec<Setting> {
    let mut known = Plant::from(base.params());
    let mut settings = Vec::new();
    for section in plant_sections() {
        let values = visit_plant(plant, section, Values).unwrap_or_default();
        let known = visit_plant(&mut known, section, Values).unwrap_or_default();
        let changed = values
            .iter()
            .zip(known)
            .filter(|(value, known)| *value != known);
        settings.extend(changed.map(|(&(key, value), _)| Setting {
            section,
            key,
            value,
        }));
    }
    settings
}

/// All values of a table.
struct Values;

impl Visitor for Values {
    type Output = Vec<(&'static str, f64)>;

    fn visit<T: ParameterTable>(self, table: &mut T) -> Self::Output {
        let fields = T::FIELDS.iter();
        fields
            .map(|field| (field.name, (field.get)(table)))
            .collect()
    }
}

const TICK_HZ: Key = Key {
    name: "tick_hz",
    what: "control rate",
    value: Value::Number {
        unit: "Hz",
        min: leadscrew::units::TICK_HZ.0,
        max: leadscrew::units::TICK_HZ.1,
    },
    default: Some(1000.0),
};
const BANDWIDTH: Key = Key {
    name: "bandwidth_rad_per_s",
    what: "where the poles of the loop are placed",
    value: Value::Number {
        unit: "rad/s",
        min: 1.0,
        max: 1000.0,
    },
    default: Some(BANDWIDTH_RAD_PER_S),
};

const TUNING: Key = Key {
    name: "tuning",
    what: "how the loop is tuned",
    value: Value::Word(&["place-poles", "autotune"]),
    default: Some(0.0),
};

/// `[axis]`.
pub struct AxisPart {
    pub tick_hz: f64,
    pub tuning: Tuning,
    pub settings: Vec<Setting>,
}

impl AxisPart {
    pub fn read(table: Option<&DeTable<'_>>) -> Result<Self, Complaint> {
        let empty = DeTable::new();
        let table = table.unwrap_or(&empty);
        let keys = [&TICK_HZ, &BANDWIDTH, &TUNING];
        let mut axis = any_axis();
        let sections = Sections::of(&mut axis);
        let values = read_all(table, &keys, &sections, "[axis]", 0..0)?;
        let mut settings = Vec::new();
        for (key, value) in table {
            let name: &str = key.get_ref();
            let Some(&section) = sections.iter().find(|section| **section == name) else {
                continue;
            };
            let DeValue::Table(table) = value.get_ref() else {
                return Err(Complaint::new(
                    key.span(),
                    format!("`{name}` is a section: write [axis.{name}] and its keys below it"),
                ));
            };
            let fill = FillSetting { section, table };
            if let Some(read) = visit_axis(&mut axis, section, fill) {
                settings.extend(read?);
            }
        }
        Ok(Self {
            tick_hz: values[0],
            tuning: tuning(table, values[1], values[2] == 1.0)?,
            settings,
        })
    }
}

fn tuning(
    table: &DeTable<'_>,
    bandwidth_rad_per_s: f64,
    is_autotuned: bool,
) -> Result<Tuning, Complaint> {
    if !is_autotuned {
        return Ok(Tuning::PlacePoles {
            bandwidth_rad_per_s,
        });
    }
    match table.get(BANDWIDTH.name) {
        None => Ok(Tuning::Autotune),
        Some(value) => Err(Complaint::new(
            value.span(),
            "autotune finds the bandwidth itself: leave bandwidth_rad_per_s out, or write tuning = \"place-poles\"",
        )),
    }
}

/// An axis whose tables are looked at, not used.
fn any_axis() -> AxisParams {
    AxisParams::new(EstimatorConfig::Difference(difference::Config))
}

/// Names of the sections of an axis.
#[derive(Default)]
struct Sections(Vec<&'static str>);

impl Sections {
    fn of(axis: &mut AxisParams) -> Vec<&'static str> {
        let mut sections = Self::default();
        axis.visit_sections(&mut sections);
        sections.0
    }
}

impl SectionVisitor for Sections {
    fn section<T: ParameterTable>(&mut self, name: &'static str, _: &mut T) {
        self.0.push(name);
    }
}

/// Checks the keys of a section and lists them.
struct FillSetting<'a> {
    section: &'static str,
    table: &'a DeTable<'a>,
}

impl Visitor for FillSetting<'_> {
    type Output = Result<Vec<Setting>, Complaint>;

    fn visit<T: ParameterTable>(self, params: &mut T) -> Self::Output {
        let Self { section, table } = self;
        fill(params, &format!("axis.{section}"), table)?;
        let is_set = |name: &str| table.get(name).is_some();
        let set = T::FIELDS.iter().filter(|field| is_set(field.name));
        Ok(set
            .map(|field| Setting {
                section,
                key: field.name,
                value: (field.get)(params),
            })
            .collect())
    }
}

const SEED: Key = Key {
    name: "seed",
    what: "of everything random",
    value: Value::Whole {
        min: 0,
        max: u32::MAX,
    },
    default: Some(1.0),
};
const MAP: Key = Key {
    name: "map",
    what: "\"learned\": by the product's own calibration, in use from its first index on",
    value: Value::Word(&["none", "learned"]),
    default: Some(0.0),
};

/// `[encoder]`.
pub struct EncoderPart {
    pub seed: u64,
    pub mapped: bool,
    pub estimator: &'static str,
    /// A second one, for display.
    pub display: Option<&'static str>,
}

impl EncoderPart {
    pub fn read(table: Option<&DeTable<'_>>) -> Result<Self, Complaint> {
        let empty = DeTable::new();
        let table = table.unwrap_or(&empty);
        let keys = [&SEED, &MAP];
        let values = read_all(table, &keys, &["estimator", "display"], "[encoder]", 0..0)?;
        Ok(Self {
            seed: values[0] as u64,
            mapped: values[1] == 1.0,
            estimator: estimator(table, "estimator")?.unwrap_or("exponential"),
            display: estimator(table, "display")?,
        })
    }
}

fn estimator(table: &DeTable<'_>, key: &str) -> Result<Option<&'static str>, Complaint> {
    let names = EstimatorConfig::NAMES;
    let Some(value) = table.get(key) else {
        return Ok(None);
    };
    let word = value.get_ref().as_str().unwrap_or_default();
    let found = names.iter().find(|name| **name == word);
    found.copied().map(Some).ok_or_else(|| {
        let hint = suggestion(word, names.iter().copied());
        Complaint::new(value.span(), format!("unknown estimator `{word}`{hint}"))
    })
}
