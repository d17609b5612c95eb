//! Tools, and what is to be cut.

use super::Evaluation;
use crate::metrology::part::report::FeatureReport;
use crate::metrology::part::{Blank, Feature, Kind, PassesPlan, ToolPlan};
use crate::metrology::passes::{self, Cut};
use crate::metrology::relations::Uncertain;
use crate::metrology::{Axis, MetrologyError, Touch, tool};

impl Evaluation<'_> {
    pub(super) fn tool(
        &self,
        feature: &Feature,
        plan: &ToolPlan,
    ) -> Result<FeatureReport, MetrologyError> {
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

    pub(super) fn passes(
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
}
