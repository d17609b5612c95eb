//! The part before and after, its deviations enlarged.

use std::f64::consts::TAU;

use leadscrew_process::metrology::Touch;
use leadscrew_process::prove_out::{Feature, ProveOut};

use crate::plot::{Colour, Plane, PlaneFigure, Series};

/// How much deviations are enlarged in the first two planes, and how much more in the third.
const ENLARGED: f64 = 100.0;
const MORE: f64 = 20.0;
/// Points of a circle.
const POINTS: usize = 72;

/// Front views of the part: after the first pass, after the corrected program, the latter again enlarged more.
pub(super) fn figure(out: &ProveOut) -> PlaneFigure {
    let plane = |touches: &[(Feature, Touch)], enlarged: f64, label: &str, named: bool| {
        let name = |text: &str| {
            if named {
                text.to_owned()
            } else {
                String::new()
            }
        };
        let (mut planned, mut actual, mut depth) = (Vec::new(), Vec::new(), Vec::new());
        for feature in Feature::CUT {
            let own = touches.iter().filter(|(one, _)| *one == feature);
            let own: Vec<&Touch> = own.map(|(_, touch)| touch).collect();
            match feature {
                Feature::Face => depth.extend(own.iter().flat_map(|touch| arrow(touch, enlarged))),
                Feature::Bore(_) => {
                    planned.extend(circle(&own, 0.0));
                    actual.extend(circle(&own, enlarged));
                }
                _ => {
                    planned.extend(line(&own, 0.0));
                    actual.extend(line(&own, enlarged));
                }
            }
        }
        Plane {
            x_label: format!("x, mm: {label}, deviations × {enlarged}"),
            y_label: "y, mm".to_owned(),
            series: vec![
                Series::line(name("as planned"), planned, Colour::Grey).with_width(1.4),
                Series::line(name("as it is"), actual, Colour::Blue).with_width(2.0),
                Series::line(name("Δz of the face, upwards"), depth, Colour::Vermillion)
                    .with_width(2.5),
                // All planes of one size.
                Series::dots("", vec![(-95.0, -70.0), (95.0, 70.0)], Colour::Grey).with_width(0.5),
            ],
        }
    };
    PlaneFigure {
        title: "Prove-out: a part before and after its program was corrected".to_owned(),
        planes: vec![
            plane(&out.true_before, ENLARGED, "before", true),
            plane(&out.true_after, ENLARGED, "after", false),
            plane(&out.true_after, ENLARGED * MORE, "after", false),
        ],
    }
}

const GAP: (f64, f64) = (f64::NAN, f64::NAN);

fn moved(touch: &Touch, enlarged: f64) -> (f64, f64) {
    let at = |i: usize| touch.nominal[i] + enlarged * (touch.measured[i] - touch.nominal[i]);
    (at(0), at(1))
}

fn line(touches: &[&Touch], enlarged: f64) -> Vec<(f64, f64)> {
    let mut points: Vec<_> = touches.iter().map(|touch| moved(touch, enlarged)).collect();
    points.push(GAP);
    points
}

/// A bore about the centre that its four touches show.
fn circle(touches: &[&Touch], enlarged: f64) -> Vec<(f64, f64)> {
    let count = touches.len().max(1) as f64;
    let mean =
        |of: &dyn Fn(&Touch) -> f64| touches.iter().map(|touch| of(touch)).sum::<f64>() / count;
    let centre = (
        mean(&|touch| touch.nominal[0]),
        mean(&|touch| touch.nominal[1]),
    );
    // Opposite touches: the mean of what is seen along an axis is half of its sum.
    let off = |i: usize| 2.0 * mean(&|touch| touch.measured[i] - touch.nominal[i]);
    let radius = touches.first().map_or(0.0, |touch| {
        (touch.nominal[0] - centre.0).hypot(touch.nominal[1] - centre.1)
    });
    let point = |i: usize| {
        let angle = TAU * i as f64 / POINTS as f64;
        (
            centre.0 + enlarged * off(0) + radius * angle.cos(),
            centre.1 + enlarged * off(1) + radius * angle.sin(),
        )
    };
    (0..=POINTS).map(point).chain([GAP]).collect()
}

/// The deviation of the face at a touch, drawn upwards.
fn arrow(touch: &Touch, enlarged: f64) -> [(f64, f64); 3] {
    let [x, y, _] = touch.nominal;
    [(x, y), (x, y + enlarged * touch.along_normal_mm()), GAP]
}
