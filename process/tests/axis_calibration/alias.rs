//! Targets at multiples of the pitch do not see what the screw does in a turn.

use leadscrew_process::axis_calibration::{Alias, Calibration, Expansion};

use crate::{assert_near, runs_of};

const PITCH_MM: f64 = 10.0;

/// A screw that is off by 5 µm to either side in each turn, and by 3 µm a metre.
fn screw(target: f64) -> f64 {
    5.0 * (std::f64::consts::TAU * target / PITCH_MM).sin() + 3.0 * target / 1000.0
}

fn range_of_means(targets: &[f64]) -> f64 {
    let runs = runs_of(targets, 5, |target, _, _| screw(target));
    let found = Calibration::of(&runs, &Expansion::default(), true).unwrap();
    found.axis.mean_range_um
}

#[test]
fn multiples_of_the_pitch_hide_the_error_of_a_turn_and_are_found() {
    let multiples: Vec<f64> = (0..=10).map(|at| 2.5 + 50.0 * f64::from(at)).collect();
    assert_near(range_of_means(&multiples), 1.5, 1e-9);
    let alias = Alias::of(&multiples, PITCH_MM).unwrap();
    assert!(alias.is_pitch && alias.coherence > 0.999);
    let said = alias.to_string();
    assert!(
        said.starts_with("the targets lie at multiples of the pitch, 10 mm (coherence 1.00)"),
        "{said}"
    );
    assert!(said.contains("2.5, 52.5, 102.5"), "{said}");
    // At offsets all over the pitch nearly all of its 10 µm are seen.
    let offsets = [0.3, 6.1, 2.4, 8.8, 4.7, 1.6, 7.5, 3.3, 9.6, 5.2, 0.9];
    let spread: Vec<f64> = multiples
        .iter()
        .zip(offsets)
        .map(|(at, offset)| at + offset)
        .collect();
    assert!(range_of_means(&spread) > 9.0, "{}", range_of_means(&spread));
    assert_eq!(Alias::of(&spread, PITCH_MM), None);
}

#[test]
fn multiples_of_half_the_pitch_hide_what_comes_twice_a_turn() {
    let halves: Vec<f64> = (0..10).map(|at| 35.0 * f64::from(at)).collect();
    let alias = Alias::of(&halves, PITCH_MM).unwrap();
    assert!(!alias.is_pitch);
    assert_near(alias.period_mm, 5.0, 0.0);
    // Nearly multiples are as blind.
    let nearly: Vec<f64> = (0..10)
        .map(|at| 40.0 * f64::from(at) + 0.3 * f64::from(at % 3))
        .collect();
    assert!(Alias::of(&nearly, PITCH_MM).unwrap().is_pitch);
}
