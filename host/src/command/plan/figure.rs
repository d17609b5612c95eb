//! Figures 3, 4 and 5 of the paper on cycle frequencies.

use leadscrew::units::RangeError;
use leadscrew_process::plan::curves::{
    Curve, FIGURE_3_RADIUS_MM, FIGURE_4_COUNTS_PER_MM, FIGURE_4_FEED_MM_PER_MIN, allowed_feed,
    frequency_against_feed, frequency_against_resolution,
};
use leadscrew_process::plan::{AxisPlan, MachinePlan};

use crate::cli::PlanFigure;
use crate::plot::{Colour, Figure, Panel, Series};

/// The axes of the paper's figure 3.
const FIGURE_3: [(&str, &str); 3] = [
    ("MIKRON UCP 710", "X"),
    ("MIKRON UCP 710", "Z"),
    ("MA655SM30A", "X"),
];
/// Figure 4 shows frequencies to here, Hz.
const FIGURE_4_HZ: f64 = 4000.0;

/// The figure, of one machine or of the paper.
///
/// # Errors
/// [`RangeError`] for what the curves cannot be drawn of.
pub fn of(
    figure: PlanFigure,
    one: Option<&MachinePlan>,
    plans: &[MachinePlan],
    allowed_d: f64,
) -> Result<Figure, RangeError> {
    match figure {
        PlanFigure::AllowedFeed => Ok(figure_3(one, plans)),
        PlanFigure::FrequencyAgainstFeed => figure_4(one, allowed_d),
        PlanFigure::FrequencyAgainstResolution => figure_5(allowed_d),
    }
}

fn line(curve: Curve, colour: Colour) -> Series {
    Series::line(curve.name, curve.points, colour)
}

fn dashed(curve: Curve, colour: Colour) -> Series {
    Series::dashed(curve.name, curve.points, colour)
}

fn figure_3(one: Option<&MachinePlan>, plans: &[MachinePlan]) -> Figure {
    let axes: Vec<(&MachinePlan, &AxisPlan)> = match one {
        Some(plan) => plan.axes.iter().map(|axis| (plan, axis)).collect(),
        None => plans
            .iter()
            .flat_map(|plan| plan.axes.iter().map(move |axis| (plan, axis)))
            .filter(|(plan, axis)| FIGURE_3.contains(&(&plan.machine, &axis.name)))
            .collect(),
    };
    let panels = axes.iter().map(|(plan, axis)| {
        let curves = allowed_feed(&axis.kinematics, FIGURE_3_RADIUS_MM);
        let series = curves.into_iter().map(|curve| match &*curve.name {
            "by acceleration" => line(curve, Colour::Blue),
            "by jerk" => line(curve, Colour::Vermillion),
            _ => dashed(curve, Colour::Black),
        });
        let most = 1.25 * axis.kinematics.max_feed_mm_per_min();
        let label = format!("{} {}, mm/min", plan.machine, axis.name);
        Panel::new("radius, mm", label, series.collect()).with_y_limits(0.0, most)
    });
    Figure::new("Feed allowed on a radius", panels.collect())
}

fn figure_4(one: Option<&MachinePlan>, allowed_d: f64) -> Result<Figure, RangeError> {
    let counts_per_mm = one.map_or(FIGURE_4_COUNTS_PER_MM, |plan| plan.largest.counts_per_mm());
    let [radii, overloads, jerks] =
        frequency_against_feed(counts_per_mm, FIGURE_4_FEED_MM_PER_MIN, allowed_d)?;
    let colours = || (0..).map(Colour::cycle);
    let mut series: Vec<_> = overloads
        .into_iter()
        .zip(colours())
        .map(|(curve, colour)| dashed(curve, colour).with_width(1.2))
        .collect();
    let points = jerks.into_iter().zip(colours());
    series.extend(
        points
            .map(|(curve, colour)| Series::dots(curve.name, curve.points, colour).with_width(3.0)),
    );
    series.extend(
        radii
            .into_iter()
            .zip(colours())
            .map(|(curve, colour)| line(curve, colour)),
    );
    // The picture of the paper, for other resolutions in proportion.
    let most = FIGURE_4_HZ * (counts_per_mm / FIGURE_4_COUNTS_PER_MM / allowed_d).sqrt();
    let panel = Panel::new("feed, mm/min", "cycle frequency, Hz", series).with_y_limits(0.0, most);
    let title =
        format!("Cycle frequency for a chord error of {allowed_d} d at {counts_per_mm} d/mm");
    let mut figure = Figure::new(title, vec![panel]);
    figure.height = 600;
    Ok(figure)
}

fn figure_5(allowed_d: f64) -> Result<Figure, RangeError> {
    let curves = frequency_against_resolution(allowed_d)?;
    let colours = (0..).map(Colour::cycle);
    let series = curves.into_iter().zip(colours);
    let series = series.map(|(curve, colour)| line(curve, colour)).collect();
    let panel = Panel::new("resolution, d/mm", "cycle frequency, Hz", series).with_log_y();
    let title = format!("Cycle frequency for a chord error of {allowed_d} d by overload");
    let mut figure = Figure::new(title, vec![panel]).with_log_x();
    figure.height = 600;
    Ok(figure)
}
