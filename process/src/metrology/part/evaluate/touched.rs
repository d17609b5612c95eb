//! Features that are touched themselves.

use super::{Evaluation, Found, push_form, push_rotations, push_vector};
use crate::metrology::bore::Bore;
use crate::metrology::part::report::FeatureReport;
use crate::metrology::relations::Uncertain;
use crate::metrology::{
    Axis, Fitted, MetrologyError, Nominal, Touch, circle, plane, shoulder, tool,
};

impl Evaluation<'_> {
    pub(super) fn plane(
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

    pub(super) fn shoulder(
        &self,
        index: usize,
        touches: &[Touch],
        along: Axis,
    ) -> Result<FeatureReport, MetrologyError> {
        let fitted = shoulder::fit(touches, along, self.settings)?;
        let mut report = self.report(index, "shoulder", &fitted);
        let (value, sigma) = (fitted.value, fitted.sigma);
        // The fit takes faces square to an axis only.
        let normal = Axis::along(touches[0].normal).map_or("normal", Axis::name);
        report.push(
            format!("offset {normal}"),
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

    pub(super) fn circle(
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

    pub(super) fn bore(
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

    pub(super) fn turned(
        &self,
        index: usize,
        nominal: &Nominal,
        fitted: &Fitted<Bore>,
    ) -> FeatureReport {
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
}
