//! The features of a part by its touches.

use leadscrew_nc::source::Complaint;

use super::report::{FeatureReport, Report};
use super::{Blank, Feature, Kind, Part, PassesPlan, ToolPlan, Touches};
use crate::metrology::bore::{self, Bore};
use crate::metrology::circle::{self, Circle};
use crate::metrology::passes::{self, Cut};
use crate::metrology::plane::{self, Plane};
use crate::metrology::relations::{self, Placed, Uncertain};
use crate::metrology::{
    Axis, Fitted, MetrologyError, Nominal, Settings, Touch, setting, shoulder, tool,
};

/// Computes all features. `text` is that of the part's file, for complaints.
///
/// # Errors
/// A feature that its touches do not determine, at its place in the part's file.
pub fn evaluate(
    text: &str,
    part: &Part,
    touches: &Touches,
    settings: &Settings,
) -> Result<Report, Complaint> {
    let mut evaluation = Evaluation {
        part,
        touches,
        settings,
        found: Vec::new(),
    };
    let mut features = Vec::new();
    for (index, feature) in part.features.iter().enumerate() {
        let report = evaluation.feature(index);
        features.push(report.map_err(|error| feature.complain(text, error))?);
    }
    Ok(Report { features })
}

/// What later features are computed from.
enum Found {
    Plane(Fitted<Plane>),
    Circle(Fitted<Circle>),
    Bore(Fitted<Bore>),
    Nothing,
}

struct Evaluation<'a> {
    part: &'a Part,
    touches: &'a Touches,
    settings: &'a Settings,
    found: Vec<Found>,
}

impl Evaluation<'_> {
    fn feature(&mut self, index: usize) -> Result<FeatureReport, MetrologyError> {
        let feature = &self.part.features[index];
        let touches: Vec<Touch> = self.of(index).iter().map(|(_, touch)| *touch).collect();
        let (report, found) = match &feature.kind {
            Kind::Plane => self.plane(index, &touches)?,
            Kind::Shoulder { along } => (self.shoulder(index, &touches, *along)?, Found::Nothing),
            Kind::Circle { nominal, inside } => self.circle(index, nominal, *inside, &touches)?,
            Kind::Axis {
                nominal, diameters, ..
            } => {
                let fitted = bore::fit(nominal, &touches, *diameters, self.settings)?;
                (
                    self.bore(index, "axis", nominal, &fitted),
                    Found::Bore(fitted),
                )
            }
            Kind::Turned { nominal, .. } => {
                let fitted = bore::fit_turned(nominal, &touches, self.settings)?;
                (self.turned(index, nominal, &fitted), Found::Bore(fitted))
            }
            Kind::Coaxiality { of, turn } => (
                self.coaxiality(feature, *of, turn.as_ref())?,
                Found::Nothing,
            ),
            Kind::Distance { of } => (self.distance(feature, *of)?, Found::Nothing),
            Kind::Perpendicularity { axis, face } => (
                self.perpendicularity(feature, *axis, *face)?,
                Found::Nothing,
            ),
            Kind::Tool(plan) => (self.tool(feature, plan)?, Found::Nothing),
            Kind::Passes(plan) => (self.passes(feature, plan)?, Found::Nothing),
            Kind::Setting { of, free } => (self.setting(feature, of, *free)?, Found::Nothing),
        };
        self.found.push(found);
        Ok(report)
    }

    fn of(&self, index: usize) -> &[(String, Touch)] {
        self.touches.get(index).map_or(&[], Vec::as_slice)
    }

    /// A report with what the fit says of the feature's touches.
    fn report<T>(&self, index: usize, kind: &'static str, fitted: &Fitted<T>) -> FeatureReport {
        let mut report = FeatureReport::new(&self.part.features[index].name, kind);
        let touches = self.of(index).iter();
        let touches = touches.map(|(point, touch)| (point.clone(), touch.along_normal_mm()));
        report.describe(&fitted.quality, touches);
        report
    }

    fn plane(
        &self,
        index: usize,
        touches: &[Touch],
    ) -> Result<(FeatureReport, Found), MetrologyError> {
        let fitted = plane::fit(touches, self.settings)?;
        let mut report = self.report(index, "plane", &fitted);
        let (value, sigma) = (&fitted.value, &fitted.sigma);
        let normal = Axis::along(touches[0].normal);
        let along = normal.map_or("normal", Axis::name);
        report.push(
            format!("offset {along}"),
            "mm",
            value.offset_mm,
            sigma.map(|sigma| sigma.offset_mm),
        );
        push_rotations(
            &mut report,
            value.rotation,
            sigma.map(|sigma| sigma.rotation),
            |axis| Some(axis) != normal,
        );
        push_form(&mut report, &fitted, "flatness");
        Ok((report, Found::Plane(fitted)))
    }

    fn shoulder(
        &self,
        index: usize,
        touches: &[Touch],
        along: Axis,
    ) -> Result<FeatureReport, MetrologyError> {
        let fitted = shoulder::fit(touches, along, self.settings)?;
        let mut report = self.report(index, "shoulder", &fitted);
        let (value, sigma) = (fitted.value, fitted.sigma);
        report.push(
            "width",
            "mm",
            value.offset_mm,
            sigma.map(|sigma| sigma.offset_mm),
        );
        report.push(
            value.about.rotation_name(),
            "rad",
            value.turn,
            sigma.map(|sigma| sigma.turn),
        );
        push_form(&mut report, &fitted, "straightness");
        Ok(report)
    }

    fn circle(
        &self,
        index: usize,
        nominal: &Nominal,
        inside: bool,
        touches: &[Touch],
    ) -> Result<(FeatureReport, Found), MetrologyError> {
        let fitted = circle::fit(nominal, touches, self.settings)?;
        let mut report = self.report(index, if inside { "hole" } else { "boss" }, &fitted);
        let (value, sigma) = (fitted.value, fitted.sigma);
        push_vector(
            &mut report,
            "centre",
            value.centre_mm,
            sigma.map(|sigma| sigma.centre_mm),
            value.seen,
        );
        let diameter_sigma = sigma.map(|sigma| sigma.diameter_mm);
        report.push(
            "diameter",
            "mm",
            nominal.diameter_mm + value.diameter_mm,
            diameter_sigma,
        );
        report.push("diameter error", "mm", value.diameter_mm, diameter_sigma);
        for diameter in circle::diameters(nominal, touches)? {
            let of = diameter
                .touches
                .map(|touch| self.of(index)[touch].0.as_str());
            let sigmas = diameter.touches.map(|touch| touches[touch].sigma_mm);
            let sigma = sigmas[0].zip(sigmas[1]).map(|(a, b)| a.hypot(b));
            report.push(
                format!("diameter error {}-{}", of[0], of[1]),
                "mm",
                diameter.deviation_mm,
                sigma,
            );
        }
        if let Some(ovality) = value.ovality_mm {
            report.push(
                "ovality",
                "mm",
                ovality,
                sigma.and_then(|sigma| sigma.ovality_mm),
            );
        }
        if let Some(form) = value.form_mm {
            report.push("roundness", "mm", form, None);
        }
        Ok((report, Found::Circle(fitted)))
    }

    fn bore(
        &self,
        index: usize,
        kind: &'static str,
        nominal: &Nominal,
        fitted: &Fitted<Bore>,
    ) -> FeatureReport {
        let mut report = self.report(index, kind, fitted);
        let (value, sigma) = (&fitted.value, fitted.sigma.as_ref());
        push_vector(
            &mut report,
            "offset",
            value.offset_mm,
            sigma.map(|sigma| sigma.offset_mm),
            value.seen,
        );
        // An offset along one axis is seen with the rotation about the other.
        let [first, second] = nominal.across();
        let turns = |axis: Axis| {
            let other = if axis == first { second } else { first };
            axis != nominal.axis && value.seen[other.index()]
        };
        if value.sections.len() > 1 {
            push_rotations(
                &mut report,
                value.rotation,
                sigma.map(|sigma| sigma.rotation),
                turns,
            );
        }
        for (number, [height, deviation]) in value.sections.iter().enumerate() {
            let place = nominal.centre_mm[nominal.axis.index()] + height;
            let planned = nominal.diameter_mm + nominal.taper * height;
            let sigma = sigma.map(|sigma| sigma.sections[number][1]);
            let at = format!("at {} {place}", nominal.axis.name());
            report.push(format!("diameter {at}"), "mm", planned + deviation, sigma);
            report.push(format!("diameter error {at}"), "mm", *deviation, sigma);
        }
        if let Some(taper) = value.taper {
            let sigma = sigma.and_then(|sigma| sigma.taper);
            report.push("taper error", "mm/mm", taper, sigma);
        }
        push_form(&mut report, fitted, "cylindricity");
        report
    }

    fn turned(&self, index: usize, nominal: &Nominal, fitted: &Fitted<Bore>) -> FeatureReport {
        let mut report = self.bore(index, "turned", nominal, fitted);
        if fitted.value.seen == [false; 3] {
            report.notes.push(
                "touched from one side: diameters and taper are about the planned axis".to_owned(),
            );
        }
        // All sections are off alike, but for the taper: the first one tells the tip.
        let sigma = fitted.sigma.as_ref().map(|sigma| sigma.sections[0][1]);
        let tip = tool::tip_by_diameter(Uncertain {
            value: fitted.value.sections[0][1],
            sigma,
        });
        report.push("tool tip x", "mm", tip.value, tip.sigma);
        report
    }

    fn placed(&self, index: usize) -> Option<Placed<'_>> {
        match (&self.part.features[index].kind, self.found.get(index)?) {
            (Kind::Circle { nominal, .. }, Found::Circle(circle)) => {
                Some(Placed { nominal, circle })
            }
            _ => None,
        }
    }

    fn circles(&self, of: [usize; 2]) -> Result<[Placed<'_>; 2], MetrologyError> {
        match of.map(|index| self.placed(index)) {
            [Some(first), Some(second)] => Ok([first, second]),
            _ => Err(MetrologyError::Impossible {
                what: "it",
                reason: "it is not of two holes or bosses".to_owned(),
            }),
        }
    }

    fn coaxiality(
        &self,
        feature: &Feature,
        of: [usize; 2],
        turn: Option<&relations::TableTurn>,
    ) -> Result<FeatureReport, MetrologyError> {
        let [first, second] = self.circles(of)?;
        let found = relations::coaxiality(first, second, turn)?;
        let mut report = FeatureReport::new(&feature.name, "coaxiality");
        let (value, sigma) = (found.value, found.sigma);
        report.push(
            "e",
            "mm",
            value.eccentricity_mm,
            sigma.map(|sigma| sigma.eccentricity_mm),
        );
        let across = |axis: Axis| axis != first.nominal.axis;
        let seen = Axis::ALL.map(across);
        push_vector(
            &mut report,
            "e",
            value.offset_mm,
            sigma.map(|sigma| sigma.offset_mm),
            seen,
        );
        push_rotations(
            &mut report,
            value.rotation,
            sigma.map(|sigma| sigma.rotation),
            across,
        );
        Ok(report)
    }

    fn distance(&self, feature: &Feature, of: [usize; 2]) -> Result<FeatureReport, MetrologyError> {
        let [first, second] = self.circles(of)?;
        let found = relations::distance(first, second)?;
        let mut report = FeatureReport::new(&feature.name, "distance");
        let sigma = found.sigma.map(|sigma| sigma.deviation_mm);
        report.push("distance", "mm", found.value.measured_mm, sigma);
        report.push("distance error", "mm", found.value.deviation_mm, sigma);
        Ok(report)
    }

    fn perpendicularity(
        &self,
        feature: &Feature,
        axis: usize,
        face: usize,
    ) -> Result<FeatureReport, MetrologyError> {
        let mut report = FeatureReport::new(&feature.name, "perpendicularity");
        let of = (
            &self.part.features[axis].kind,
            &self.found[axis],
            &self.found[face],
        );
        if let (Kind::Axis { nominal, .. }, Found::Bore(bore), Found::Plane(plane)) = of {
            let normal = self
                .of(face)
                .first()
                .and_then(|(_, touch)| Axis::along(touch.normal));
            if normal != Some(nominal.axis) {
                return Err(MetrologyError::Impossible {
                    what: "a perpendicularity",
                    reason: "the face is not planned square to the axis".to_owned(),
                });
            }
            let found = relations::perpendicularity((nominal, bore), plane)?;
            push_rotations(&mut report, found.value, found.sigma, |about| {
                about != nominal.axis
            });
        }
        Ok(report)
    }

    fn tool(&self, feature: &Feature, plan: &ToolPlan) -> Result<FeatureReport, MetrologyError> {
        let fitted = tool::setting(
            &plan.touched_mm,
            plan.setter_mm,
            plan.sigma_mm,
            self.settings,
        )?;
        let mut report = FeatureReport::new(&feature.name, "tool");
        let touches = (1..).zip(&plan.touched_mm);
        let touches = touches.map(|(number, touched): (u32, &f64)| {
            (number.to_string(), touched - plan.setter_mm - fitted.value)
        });
        report.describe(&fitted.quality, touches);
        report.push("setting", "mm", fitted.value, fitted.sigma);
        if let Some((then, sigma)) = plan.then {
            let now = Uncertain {
                value: fitted.value,
                sigma: fitted.sigma,
            };
            let wear = tool::wear(now, Uncertain { value: then, sigma });
            report.push("wear", "mm", wear.value, wear.sigma);
        }
        Ok(report)
    }

    fn passes(
        &self,
        feature: &Feature,
        plan: &PassesPlan,
    ) -> Result<FeatureReport, MetrologyError> {
        let mut report = FeatureReport::new(&feature.name, "passes");
        let (stock, scale) = self.stock(plan)?;
        report.push("stock", "mm", stock, None);
        if stock < 0.0 {
            return Err(MetrologyError::Range {
                name: "stock",
                value: stock,
                unit: "mm",
                allowed: "0 or more: the blank is smaller than what is wanted".to_owned(),
            });
        }
        let passes = passes::passes(&Cut {
            blank_mm: stock,
            finished_mm: 0.0,
            max_depth_mm: plan.max_depth_mm,
            finishing_mm: plan.finishing_mm,
        })?;
        report.push("passes", "", passes.len() as f64, None);
        for (number, pass) in (1..).zip(&passes) {
            let number: u32 = number;
            report.push(format!("depth {number}"), "mm", pass.depth_mm, None);
            report.push(
                format!("size {number}"),
                "mm",
                plan.finished_mm + scale * pass.size_mm,
                None,
            );
        }
        Ok(report)
    }

    /// What stands over the finished surface where it stands out most, across the surface; and what a coordinate or a diameter
    /// grows by with it.
    fn stock(&self, plan: &PassesPlan) -> Result<(f64, f64), MetrologyError> {
        let of = match plan.blank {
            Blank::Stated(blank) => {
                let stock = blank - plan.finished_mm;
                return Ok((stock.abs(), if stock < 0.0 { -1.0 } else { 1.0 }));
            }
            Blank::Of(of) => of,
        };
        let largest = |size: &dyn Fn(&Touch) -> f64| {
            let sizes = self.of(of).iter().map(|(_, touch)| size(touch));
            sizes.fold(f64::NEG_INFINITY, f64::max)
        };
        if let Kind::Turned { nominal, inside } = self.part.features[of].kind {
            let side = if inside { -1.0 } else { 1.0 };
            let radius = |touch: &Touch| {
                let [x, y, _] = touch.measured;
                side * ((x - nominal.centre_mm[0]).hypot(y - nominal.centre_mm[1])
                    - plan.finished_mm / 2.0)
            };
            return Ok((largest(&radius), 2.0 * side));
        }
        let normal = self
            .of(of)
            .first()
            .map_or([0.0; 3], |(_, touch)| touch.normal);
        let Some(axis) = Axis::along(normal) else {
            return Err(MetrologyError::Impossible {
                what: "the number of passes",
                reason: "the face is oblique".to_owned(),
            });
        };
        let side = normal[axis.index()].signum();
        let height = |touch: &Touch| side * (touch.measured[axis.index()] - plan.finished_mm);
        Ok((largest(&height), side))
    }

    fn setting(
        &self,
        feature: &Feature,
        of: &[usize],
        free: [bool; 6],
    ) -> Result<FeatureReport, MetrologyError> {
        let all = || {
            of.iter()
                .flat_map(|&index| self.of(index).iter().map(move |touch| (index, touch)))
        };
        let touches: Vec<Touch> = all().map(|(_, (_, touch))| *touch).collect();
        let fitted = setting::fit(&touches, free, self.settings)?;
        let mut report = FeatureReport::new(&feature.name, "setting");
        let points = all().map(|(index, (point, touch))| {
            let name = &self.part.features[index].name;
            (format!("{name}/{point}"), touch.along_normal_mm())
        });
        report.describe(&fitted.quality, points);
        let sigma = fitted.sigma;
        for axis in Axis::ALL.into_iter().filter(|axis| free[axis.index()]) {
            let index = axis.index();
            let name = setting::COMPONENTS[index];
            let sigma = sigma.map(|sigma| sigma.shift_mm[index]);
            report.push(name, "mm", fitted.value.shift_mm[index], sigma);
        }
        let turns = |axis: Axis| free[3 + axis.index()];
        push_rotations(
            &mut report,
            fitted.value.rotation,
            sigma.map(|sigma| sigma.rotation),
            turns,
        );
        Ok(report)
    }
}

fn push_vector(
    report: &mut FeatureReport,
    name: &str,
    value: [f64; 3],
    sigma: Option<[f64; 3]>,
    seen: [bool; 3],
) {
    for axis in Axis::ALL.into_iter().filter(|axis| seen[axis.index()]) {
        let index = axis.index();
        let sigma = sigma.map(|sigma| sigma[index]);
        report.push(format!("{name} {}", axis.name()), "mm", value[index], sigma);
    }
}

fn push_rotations(
    report: &mut FeatureReport,
    value: [f64; 3],
    sigma: Option<[f64; 3]>,
    seen: impl Fn(Axis) -> bool,
) {
    for axis in Axis::ALL.into_iter().filter(|&axis| seen(axis)) {
        let index = axis.index();
        let sigma = sigma.map(|sigma| sigma[index]);
        report.push(axis.rotation_name(), "rad", value[index], sigma);
    }
}

fn push_form<T>(report: &mut FeatureReport, fitted: &Fitted<T>, name: &str) {
    if fitted.quality.freedom > 0 {
        report.push(name, "mm", fitted.quality.peak_to_valley_mm(), None);
    }
}
