//! The deformed working volume in its projections, as P4's Figure 7.

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::terms::grid::GridAxis;
use leadscrew_process::deviations::{Machine, Map};
use nalgebra::Vector3;

use super::data;
use crate::error::CommandError;
use crate::plot::{Colour, Plane, PlaneFigure, Series};

/// The largest deviation is drawn as this part of the distance between grid lines.
const SHARE: f64 = 0.8;
/// Pieces of a grid line between two nodes.
const PIECES: usize = 6;

/// The projections of the grid that have two moving axes, each through the middle of the others.
pub(super) fn figure(
    machine: &Machine,
    rest: &Coordinates,
    map: &Map,
) -> Result<PlaneFigure, CommandError> {
    let moving: Vec<&GridAxis> = map
        .over
        .iter()
        .filter(|one| matches!(one.axis, Axis::X | Axis::Y | Axis::Z))
        .collect();
    if moving.len() < 2 {
        return Err(CommandError::Usage(
            "--plot draws planes: let two of the axes X, Y and Z move, name fewer in --at".into(),
        ));
    }
    let enlarged = enlargement(map, &moving);
    let middle = map.over.iter().fold(*rest, |at, one| {
        let ends = (one.places[0], one.places[one.places.len() - 1]);
        at.with(one.axis, 0.5 * (ends.0 + ends.1))
    });
    let pairs = [(Axis::X, Axis::Y), (Axis::X, Axis::Z), (Axis::Z, Axis::Y)];
    // A lathe's drawings have z across.
    let pairs: &[_] = if moving.iter().any(|one| one.axis == Axis::Y) {
        &pairs
    } else {
        &[(Axis::Z, Axis::X)]
    };
    let find = |axis| moving.iter().find(|one| one.axis == axis).copied();
    let mut planes = Vec::new();
    for &(across, up) in pairs {
        if let (Some(across), Some(up)) = (find(across), find(up)) {
            planes.push(plane(
                machine,
                &middle,
                across,
                up,
                enlarged,
                planes.is_empty(),
            )?);
        }
    }
    let stands: Vec<String> = machine
        .axes()
        .iter()
        .filter(|(axis, _)| map.over.iter().all(|one| one.axis != *axis))
        .map(|(axis, _)| format!(", {axis} {}", rest[*axis]))
        .collect();
    Ok(PlaneFigure {
        title: format!(
            "{}: deviations enlarged {enlarged} times{}",
            machine.name,
            stands.concat()
        ),
        planes,
    })
}

/// 1, 2 or 5 times a power of ten.
fn enlargement(map: &Map, moving: &[&GridAxis]) -> f64 {
    let largest = map.extreme(|point| point.delta.shift.amax()).value.abs();
    let apart = moving
        .iter()
        .flat_map(|one| one.places.windows(2).map(|pair| pair[1] - pair[0]))
        .fold(f64::INFINITY, f64::min);
    if largest == 0.0 {
        return 1.0;
    }
    let wanted = (SHARE * apart / largest).max(1.0);
    let decade = 10f64.powf(wanted.log10().floor());
    let steps = [5.0, 2.0, 1.0].map(|step| step * decade);
    steps
        .into_iter()
        .find(|&step| step <= wanted)
        .unwrap_or(decade)
}

fn plane(
    machine: &Machine,
    middle: &Coordinates,
    across: &GridAxis,
    up: &GridAxis,
    enlarged: f64,
    named: bool,
) -> Result<Plane, CommandError> {
    let displaced = |at: &Coordinates| -> Result<(f64, f64), CommandError> {
        let shift = machine.deviation(at).map_err(data)?.shift;
        let along = |axis: Axis| at[axis] + enlarged * component(&shift, axis);
        Ok((along(across.axis), along(up.axis)))
    };
    let (mut nominal, mut deformed, mut nodes) = (Vec::new(), Vec::new(), Vec::new());
    let mut vectors = Vec::new();
    for (lines, along) in [(across, up), (up, across)] {
        for &line in &lines.places {
            let at = middle.with(lines.axis, line);
            for place in finer(&along.places) {
                let at = at.with(along.axis, place);
                nominal.push((at[across.axis], at[up.axis]));
                deformed.push(displaced(&at)?);
            }
            for list in [&mut nominal, &mut deformed] {
                list.push((f64::NAN, f64::NAN));
            }
        }
    }
    for &x in &across.places {
        for &y in &up.places {
            let at = middle.with(across.axis, x).with(up.axis, y);
            let end = displaced(&at)?;
            vectors.extend([(x, y), end, (f64::NAN, f64::NAN)]);
            nodes.push(end);
        }
    }
    let name = |text: &str| {
        if named {
            text.to_owned()
        } else {
            String::new()
        }
    };
    Ok(Plane {
        x_label: format!("{}, mm", across.axis),
        y_label: format!("{}, mm", up.axis),
        series: vec![
            Series::line(name("as programmed"), nominal, Colour::Grey).with_width(1.2),
            Series::line(name("as it is"), deformed, Colour::Blue).with_width(1.4),
            Series::line(name("Δ of the tool's tip"), vectors, Colour::Vermillion).with_width(2.0),
            Series::dots("", nodes, Colour::Vermillion).with_width(6.0),
        ],
    })
}

fn component(shift: &Vector3<f64>, axis: Axis) -> f64 {
    match axis {
        Axis::X => shift.x,
        Axis::Y => shift.y,
        _ => shift.z,
    }
}

/// The places with further ones between them.
fn finer(places: &[f64]) -> Vec<f64> {
    let mut all: Vec<f64> = places
        .windows(2)
        .flat_map(|ends| {
            let step = (ends[1] - ends[0]) / PIECES as f64;
            (0..PIECES).map(move |piece| ends[0] + step * piece as f64)
        })
        .collect();
    all.extend(places.last());
    all
}
