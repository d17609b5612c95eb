//! The features of a part by its touches.

mod related;
mod shop;
mod touched;

use leadscrew_nc::source::Complaint;

use super::report::{FeatureReport, Report};
use super::{Kind, Part, Touches};
use crate::metrology::bore::{self, Bore};
use crate::metrology::circle::Circle;
use crate::metrology::plane::Plane;
use crate::metrology::{Axis, Fitted, MetrologyError, Settings, Touch};

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
