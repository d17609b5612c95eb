//! The standard's plot: mean deviations of both directions over the targets, and twice their scatter to either side.

use leadscrew_process::axis_calibration::{Calibration, Direction};

use crate::plot::{Colour, Figure, Panel, Series};

pub(super) fn of(calibration: &Calibration, file: &str) -> Figure {
    let mut series = Vec::new();
    let targets = &calibration.targets;
    for (way, direction) in Direction::BOTH.into_iter().enumerate() {
        let colour = [Colour::Blue, Colour::Vermillion][way];
        let name = direction.name();
        let limits = |sign: f64| {
            targets
                .iter()
                .map(|target| (target.target_mm, target.limit_um(way, sign)))
                .collect()
        };
        series.push(Series::dashed(format!("{name}, ± 2s"), limits(1.0), colour).with_width(1.2));
        series.push(Series::dashed("", limits(-1.0), colour).with_width(1.2));
        let means: Vec<_> = targets
            .iter()
            .map(|target| (target.target_mm, target.mean_um[way]))
            .collect();
        series.push(Series::dots("", means.clone(), colour).with_width(6.0));
        series.push(Series::line(format!("{name}, mean"), means, colour));
    }
    let both = targets
        .iter()
        .map(|target| (target.target_mm, target.mean_of_both_um));
    series.push(Series::line("mean of both", both.collect(), Colour::Grey));
    let axis = &calibration.axis;
    let title = format!(
        "{file}: A {:.1} µm, E {:.1}, R {:.1}, B {:.1}, M {:.1}",
        axis.accuracy_um,
        axis.systematic_um,
        axis.repeatability_um,
        axis.reversal_um,
        axis.mean_range_um
    );
    let panel = Panel::new("target, mm", "deviation, µm", series);
    let mut figure = Figure::new(title, vec![panel]);
    figure.height = 560;
    figure
}
