//! Features that are computed from others.

use super::{Evaluation, Found, push_rotations, push_vector};
use crate::metrology::part::report::FeatureReport;
use crate::metrology::part::{Feature, Kind};
use crate::metrology::relations::{self, Placed};
use crate::metrology::{Axis, MetrologyError, Touch, setting};
use crate::setting_vector::Component;

impl Evaluation<'_> {
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

    pub(super) fn coaxiality(
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

    pub(super) fn distance(
        &self,
        feature: &Feature,
        of: [usize; 2],
    ) -> Result<FeatureReport, MetrologyError> {
        let [first, second] = self.circles(of)?;
        let found = relations::distance(first, second)?;
        let mut report = FeatureReport::new(&feature.name, "distance");
        let sigma = found.sigma.map(|sigma| sigma.deviation_mm);
        report.push("distance", "mm", found.value.measured_mm, sigma);
        report.push("distance error", "mm", found.value.deviation_mm, sigma);
        Ok(report)
    }

    pub(super) fn perpendicularity(
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

    pub(super) fn setting(
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
        for component in Component::ALL {
            if free[component.index()] {
                let unit = if component.is_turn() { "rad" } else { "mm" };
                let sigma = fitted.sigma.map(|sigma| sigma.get(component));
                let value = fitted.value.get(component);
                report.push(component.letter(), unit, value, sigma);
            }
        }
        Ok(report)
    }
}
