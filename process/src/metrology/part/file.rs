//! The file of a part: TOML.

use std::ops::Range;

use leadscrew_nc::source::{Complaint, read_toml};
use serde::Deserialize;
use toml::Spanned;

use super::kinds::{AxisFile, CircleFile, PlaneFile, ShoulderFile, TurnedFile};
use super::means::{ProbeFile, ProgramFile, TableFile};
use super::others::{
    CoaxialityFile, DistanceFile, PassesFile, PerpendicularityFile, SettingFile, ToolFile,
};
use super::{Feature, Kind, Part, Planned, Probe};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PartFile {
    #[serde(default)]
    probe: ProbeFile,
    #[serde(default)]
    table: TableFile,
    #[serde(default)]
    program: ProgramFile,
    #[serde(default)]
    plane: Vec<Spanned<PlaneFile>>,
    #[serde(default)]
    shoulder: Vec<Spanned<ShoulderFile>>,
    #[serde(default)]
    hole: Vec<Spanned<CircleFile>>,
    #[serde(default)]
    boss: Vec<Spanned<CircleFile>>,
    #[serde(default)]
    axis: Vec<Spanned<AxisFile>>,
    #[serde(default)]
    turned: Vec<Spanned<TurnedFile>>,
    #[serde(default)]
    coaxiality: Vec<Spanned<CoaxialityFile>>,
    #[serde(default)]
    distance: Vec<Spanned<DistanceFile>>,
    #[serde(default)]
    perpendicularity: Vec<Spanned<PerpendicularityFile>>,
    #[serde(default)]
    tool: Vec<Spanned<ToolFile>>,
    #[serde(default)]
    passes: Vec<Spanned<PassesFile>>,
    #[serde(default)]
    setting: Vec<Spanned<SettingFile>>,
}

/// Reads the file of a part.
///
/// # Errors
/// Where and what is wrong: a key, a number out of its range, a name twice or of nothing.
pub fn read(text: &str) -> Result<Part, Complaint> {
    let file: PartFile = read_toml(text)?;
    let probe = file.probe.read(text)?;
    let program = file.program.read(text)?;
    let table = file.table.read();
    let mut list = List {
        text,
        features: Vec::new(),
    };
    list.touched(&file)?;
    list.features.sort_by_key(|feature| feature.at.start);
    list.related(&file, &probe)?;
    Ok(Part {
        features: list.features,
        probe,
        table,
        program,
    })
}

struct List<'a> {
    text: &'a str,
    features: Vec<Feature>,
}

impl List<'_> {
    fn add(
        &mut self,
        name: &Spanned<String>,
        at: Range<usize>,
        (kind, planned): (Kind, Vec<Planned>),
    ) -> Result<(), Complaint> {
        let wrong = |message: String| Err(Complaint::at(self.text, &name.span(), message));
        let is_plain = |letter: char| letter.is_alphanumeric() || " ._-".contains(letter);
        let plain = name.get_ref();
        if plain.trim().is_empty() || !plain.chars().all(is_plain) {
            return wrong(format!(
                "name `{plain}`: expected letters, digits, blanks and . _ -"
            ));
        }
        if self.features.iter().any(|feature| &feature.name == plain) {
            return wrong(format!("name `{plain}` is there twice"));
        }
        self.features.push(Feature {
            name: plain.clone(),
            kind,
            planned,
            at,
        });
        Ok(())
    }

    fn touched(&mut self, file: &PartFile) -> Result<(), Complaint> {
        let text = self.text;
        for one in &file.plane {
            self.add(&one.get_ref().name, one.span(), one.get_ref().read(text)?)?;
        }
        for one in &file.shoulder {
            self.add(&one.get_ref().name, one.span(), one.get_ref().read(text)?)?;
        }
        for (circles, inside) in [(&file.hole, true), (&file.boss, false)] {
            for one in circles {
                self.add(
                    &one.get_ref().name,
                    one.span(),
                    one.get_ref().read(text, inside)?,
                )?;
            }
        }
        for one in &file.axis {
            self.add(&one.get_ref().name, one.span(), one.get_ref().read(text)?)?;
        }
        for one in &file.turned {
            self.add(&one.get_ref().name, one.span(), one.get_ref().read(text)?)?;
        }
        Ok(())
    }

    fn related(&mut self, file: &PartFile, probe: &Probe) -> Result<(), Complaint> {
        let text = self.text;
        for one in &file.coaxiality {
            let kind = Kind::Coaxiality {
                of: self.circles(&one.get_ref().of)?,
                turn: one.get_ref().turn(text)?,
            };
            self.add(&one.get_ref().name, one.span(), (kind, Vec::new()))?;
        }
        for one in &file.distance {
            let of = self.circles(&one.get_ref().of)?;
            self.add(
                &one.get_ref().name,
                one.span(),
                (Kind::Distance { of }, Vec::new()),
            )?;
        }
        for one in &file.perpendicularity {
            let kind = Kind::Perpendicularity {
                axis: self.find(&one.get_ref().axis, "an axis", |kind| {
                    matches!(kind, Kind::Axis { .. })
                })?,
                face: self.find(&one.get_ref().face, "a plane", |kind| {
                    matches!(kind, Kind::Plane)
                })?,
            };
            self.add(&one.get_ref().name, one.span(), (kind, Vec::new()))?;
        }
        for one in &file.tool {
            let tool = one.get_ref().read(text, probe.sigma_mm)?;
            self.add(
                &one.get_ref().name,
                one.span(),
                (Kind::Tool(tool), Vec::new()),
            )?;
        }
        for one in &file.passes {
            let is_face = |kind: &Kind| matches!(kind, Kind::Plane | Kind::Turned { .. });
            let of = one.get_ref().of.as_ref();
            let of = of
                .map(|of| self.find(of, "a plane or a turned surface", is_face))
                .transpose()?;
            let passes = one.get_ref().read(text, of)?;
            self.add(
                &one.get_ref().name,
                one.span(),
                (Kind::Passes(passes), Vec::new()),
            )?;
        }
        for one in &file.setting {
            let touched =
                (0..self.features.len()).filter(|&index| self.features[index].is_touched());
            let of = match &one.get_ref().of {
                None => touched.collect(),
                Some(names) => names
                    .iter()
                    .map(|name| self.find(name, "a feature that is touched", Kind::is_touched))
                    .collect::<Result<_, _>>()?,
            };
            let free = one.get_ref().free();
            self.add(
                &one.get_ref().name,
                one.span(),
                (Kind::Setting { of, free }, Vec::new()),
            )?;
        }
        Ok(())
    }

    fn circles(&self, names: &[Spanned<String>; 2]) -> Result<[usize; 2], Complaint> {
        let is_circle = |kind: &Kind| matches!(kind, Kind::Circle { .. });
        let [first, second] = names;
        let find = |name| self.find(name, "a hole or a boss", is_circle);
        Ok([find(first)?, find(second)?])
    }

    fn find(
        &self,
        name: &Spanned<String>,
        what: &str,
        fits: impl Fn(&Kind) -> bool,
    ) -> Result<usize, Complaint> {
        let fitting = |feature: &&Feature| fits(&feature.kind);
        let is_it = |feature: &Feature| &feature.name == name.get_ref() && fits(&feature.kind);
        self.features.iter().position(is_it).ok_or_else(|| {
            let known: Vec<&str> = self
                .features
                .iter()
                .filter(fitting)
                .map(|feature| feature.name.as_str())
                .collect();
            let known = if known.is_empty() {
                "none is there".to_owned()
            } else {
                format!("there are {}", known.join(", "))
            };
            let message = format!("`{}`: expected the name of {what}; {known}", name.get_ref());
            Complaint::at(self.text, &name.span(), message)
        })
    }
}
