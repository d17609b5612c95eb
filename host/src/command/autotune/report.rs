//! What is offered, before and after, for people and programs.

use leadscrew::parameter_table::ParameterTable;
use leadscrew::params::{AxisParams, SectionVisitor};
use serde::Serialize;

use super::margins::{MarginFigures, number};
use super::{MOVE_MM, Tuned};
use crate::cli::AutotuneArgs;
use crate::command::identify;
use crate::identify::{Bench, Found};
use crate::report::{figure_or_dash, text_table};
use crate::tracking::TrackingFigures;

/// The report of an offer.
#[derive(Serialize)]
pub(super) struct Report {
    schema: &'static str,
    identification: identify::Report,
    max_feed_mm_per_min: f64,
    bandwidth_rad_per_s: f64,
    parameters: Vec<Changed>,
    margins: MarginFigures,
    /// Largest following error on the model, and on the worst of its corners, d.
    predicted_peak_d: f64,
    predicted_worst_peak_d: f64,
    before: Follows,
    after: Follows,
    /// The file that was written; null if none was.
    written: Option<String>,
}

/// A parameter that changes.
#[derive(Serialize)]
struct Changed {
    section: &'static str,
    name: &'static str,
    unit: &'static str,
    before: f64,
    after: f64,
}

/// How the machine follows; null where it does not come to its goal.
#[derive(Serialize)]
struct Follows {
    peak_d: Option<f64>,
    rms_d: Option<f64>,
    standing_d: Option<f64>,
    rest_swing_d: Option<f64>,
}

impl From<&Option<TrackingFigures>> for Follows {
    fn from(figures: &Option<TrackingFigures>) -> Self {
        let of = |value: fn(&TrackingFigures) -> f64| figures.as_ref().map(value);
        Self {
            peak_d: of(|figures| figures.following.peak()),
            rms_d: of(|figures| figures.following.rms()),
            standing_d: of(|figures| figures.standing.peak()),
            rest_swing_d: of(|figures| figures.rest_swing_d),
        }
    }
}

impl Report {
    pub(super) fn new(args: &AutotuneArgs, bench: &Bench, found: &Found, tuned: &Tuned) -> Self {
        let offer = &tuned.offer;
        let [before, after] = &tuned.follows;
        Self {
            schema: "leadscrew/autotune/1",
            identification: identify::Report::new(&args.bench, bench, found),
            max_feed_mm_per_min: tuned.max_feed_mm_per_min,
            bandwidth_rad_per_s: offer.bandwidth_rad_per_s,
            parameters: changed(tuned.before, tuned.file.axis),
            margins: offer.into(),
            predicted_peak_d: offer.trial.peak_d,
            predicted_worst_peak_d: offer.corner_trial.peak_d,
            before: before.into(),
            after: after.into(),
            written: args.out.as_ref().map(|path| path.display().to_string()),
        }
    }

    pub(super) fn to_text(&self) -> String {
        let written = match &self.written {
            Some(file) => format!("written to {file}"),
            None => "nothing was written: name a file with --out to keep them".to_owned(),
        };
        format!(
            "{}\n{}\n\n{}\n\n{}\n{written}\n",
            self.identification.to_text(),
            self.parameter_table(),
            self.margins.table(),
            self.follow_table(),
        )
    }

    fn parameter_table(&self) -> String {
        let mut table = text_table(&["parameter", "before", "after", "unit"]);
        for changed in &self.parameters {
            table.add_row([
                format!("{}.{}", changed.section, changed.name),
                number(changed.before),
                number(changed.after),
                changed.unit.to_owned(),
            ]);
        }
        table.trim_fmt()
    }

    fn follow_table(&self) -> String {
        let mut table = text_table(&[
            "following error, d",
            "peak",
            "rms",
            "standing",
            "swing at rest",
        ]);
        for (name, follows) in [
            ("machine before", &self.before),
            ("machine after", &self.after),
        ] {
            table.add_row([
                name.to_owned(),
                figure_or_dash(follows.peak_d, 1),
                figure_or_dash(follows.rms_d, 2),
                figure_or_dash(follows.standing_d, 2),
                figure_or_dash(follows.rest_swing_d, 2),
            ]);
        }
        for (name, peak) in [
            ("model, predicted", self.predicted_peak_d),
            ("worst corner, predicted", self.predicted_worst_peak_d),
        ] {
            table.add_row([name.to_owned(), format!("{peak:.1}")]);
        }
        format!(
            "machine: {MOVE_MM} mm at {} mm/min and back, the encoder's map learned; - where it did not get there\n{}",
            self.max_feed_mm_per_min,
            table.trim_fmt()
        )
    }
}

/// Parameters that differ, in the order of the sections.
fn changed(mut before: AxisParams, mut after: AxisParams) -> Vec<Changed> {
    struct Values(Vec<(&'static str, &'static str, &'static str, f64)>);
    impl SectionVisitor for Values {
        fn section<T: ParameterTable>(&mut self, section: &'static str, table: &mut T) {
            let row = |field: &leadscrew::parameter_table::Field<T>| {
                (section, field.name, field.unit, (field.get)(table))
            };
            self.0.extend(T::FIELDS.iter().map(row));
        }
    }
    let values = |axis: &mut AxisParams| {
        let mut values = Values(Vec::new());
        axis.visit_sections(&mut values);
        values.0
    };
    let pairs = values(&mut before).into_iter().zip(values(&mut after));
    let differing = pairs.filter(|(before, after)| before.3 != after.3);
    differing
        .map(|((section, name, unit, before), (.., after))| Changed {
            section,
            name,
            unit,
            before,
            after,
        })
        .collect()
}
