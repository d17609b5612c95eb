//! Maps over the working volume, and tables of corrections.

use std::fmt::Write as _;

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::terms::grid::Grid;
use leadscrew_nc::terms::{Circumstances, Term};
use leadscrew_process::deviations::{DeviationError, Machine, MapPoint};

use crate::machines::machine;

fn rows(machine: &Machine, rest: &Coordinates, at_rest: &[Axis]) -> String {
    let map = machine.map(rest, machine.evenly(at_rest, 3)).unwrap();
    let mut text = String::new();
    for MapPoint {
        at, delta, k, left, ..
    } in &map.points
    {
        for (axis, _) in machine.axes() {
            write!(text, "{axis}{:>7.1} ", at[axis]).unwrap();
        }
        // No zero has a sign: rounding gives it one here and none there.
        let plain = |value: f64, digits: i32| {
            let scale = 10f64.powi(digits);
            (value * scale).round() / scale + 0.0
        };
        let um = |v: nalgebra::Vector3<f64>| {
            let [x, y, z] = [v.x, v.y, v.z].map(|mm| plain(1e3 * mm, 2));
            format!("{x:>7.2} {y:>7.2} {z:>7.2}")
        };
        let urad = delta.turn.map(|turn| plain(1e6 * turn, 1));
        write!(
            text,
            "| Δ um {} | urad {:>6.1} {:>6.1} {:>6.1} | K",
            um(delta.shift),
            urad.x,
            urad.y,
            urad.z
        )
        .unwrap();
        for axis in machine.corrected() {
            let digits = if axis.is_rotary() { 5 } else { 4 };
            write!(text, " {axis}{:>9.digits$}", plain(k[axis], digits as i32)).unwrap();
        }
        writeln!(text, " | left um {}", um(left.shift)).unwrap();
    }
    text
}

#[test]
fn golden_map_of_the_machining_centre() {
    let rest = Coordinates::ZERO.with(Axis::B, 90.0);
    insta::assert_snapshot!(rows(&machine("6904MF2"), &rest, &[Axis::B]));
}

#[test]
fn golden_map_of_the_lathe() {
    insta::assert_snapshot!(rows(&machine("lathe"), &Coordinates::ZERO, &[]));
}

/// The table of corrections brings the true tip to where it should be: what is left is what lies between its nodes and beyond the
/// axes of the machine.
#[test]
fn the_table_of_corrections_leaves_what_it_says() {
    let machine = machine("6904MF2");
    let rest = Coordinates::ZERO.with(Axis::B, 90.0);
    let over = machine.evenly(&[Axis::B], 11);
    let grid = machine.corrections(&rest, over, 1e-3).unwrap();
    assert!(grid.includes_drive_errors());
    let left = machine.interpolation_error_mm(&rest, &grid).unwrap();
    assert!((1e-6..2e-3).contains(&left), "{left} mm between nodes");
    let with = Circumstances {
        tool_offset: Some(Coordinates::xyz(0.0, 0.0, 150.0)),
        ..Circumstances::default()
    };
    let place = rest + Coordinates::xyz(-113.0, 217.0, 61.0);
    let k = grid.correction(&place, &with).unwrap();
    let nominal = machine.nominal_tip(&place).unwrap().translation.vector;
    let off =
        |at: &Coordinates| (machine.true_tip(at).unwrap().translation.vector - nominal).norm();
    let (before, after) = (off(&place), off(&(place + k)));
    assert!(
        after < 2.0 * left + 1e-5 && after < 0.1 * before,
        "{before} → {after} mm"
    );
}

/// A table for one place of the rotary table and one tool is for no other.
#[test]
fn a_table_holds_where_it_was_made() {
    let machine = machine("6904MF2");
    let rest = Coordinates::ZERO.with(Axis::B, 90.0);
    let grid = machine
        .corrections(&rest, machine.evenly(&[Axis::B], 3), 1e-3)
        .unwrap();
    let place = rest + Coordinates::xyz(0.0, 200.0, 0.0);
    let with = |z| Circumstances {
        tool_offset: Some(Coordinates::xyz(0.0, 0.0, z)),
        ..Circumstances::default()
    };
    assert!(grid.correction(&place, &with(150.0)).is_ok());
    let turned = grid
        .correction(&place.with(Axis::B, 0.0), &with(150.0))
        .unwrap_err();
    assert!(turned.to_string().contains("B = 0"), "{turned}");
    let short = grid.correction(&place, &with(50.0)).unwrap_err();
    assert!(short.to_string().contains("tool offset"), "{short}");
}

/// K over four coordinates would be of fourth degree along a line: there is a table for each place of the rotary table instead.
#[test]
fn a_table_over_four_moving_axes_is_refused() {
    let machine = machine("6904MF2");
    let error = machine
        .corrections(&Coordinates::ZERO, machine.evenly(&[], 3), 1e-3)
        .unwrap_err();
    assert!(error.contains("more than 3 coordinates"), "{error}");
}

#[test]
fn a_table_goes_through_its_file() {
    let lathe = machine("lathe").without_drive_errors();
    let grid = lathe
        .corrections(&Coordinates::ZERO, lathe.evenly(&[], 4), 1e-3)
        .unwrap();
    assert!(!grid.includes_drive_errors());
    let text = toml::to_string(&grid).unwrap();
    assert_eq!(toml::from_str::<Grid>(&text).unwrap(), grid);
}

#[test]
fn beyond_the_ends_nothing_is_known() {
    let lathe = machine("lathe");
    let error = lathe
        .deviation(&Coordinates::xyz(0.0, 0.0, 801.0))
        .unwrap_err();
    assert!(matches!(
        error,
        DeviationError::OutOfRange { axis: Axis::Z, .. }
    ));
    assert_eq!(
        error.to_string(),
        "Z = 801 mm is beyond the ends of unit \"longitudinal slide\", 0 to 800 mm: nothing is known there"
    );
}
