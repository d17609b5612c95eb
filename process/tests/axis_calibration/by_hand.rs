//! An example small enough to work out by hand.

use leadscrew_process::axis_calibration::{Calibration, Direction, Expansion, Runs, Unfit};

use crate::{assert_near, runs_of};

/// Five targets a fifth of a metre apart, five runs: around the mean of a target the runs stand at −2, −1, 0, 1, 2 times its scatter.
///
/// | target | x̄↑ | x̄↓ | scatter ↑ | ↓ | s↑ = scatter·√2.5 | s↓ | B | 2s↑ + 2s↓ + abs(B) | R |
/// | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |
/// | 0 | 0 | −3 | 1 | 0 | 1.5811 | 0 | 3 | 6.1623 | 4s↑ = 6.3246 |
/// | 210 | 4 | 2 | 0 | 2 | 0 | 3.1623 | 2 | 8.3246 | 4s↓ = 12.6491 |
/// | 395 | 6 | 7 | 1 | 1 | 1.5811 | 1.5811 | −1 | 7.3246 | 7.3246 |
/// | 611 | 5 | 5 | 3 | 1 | 4.7434 | 1.5811 | 0 | 12.6491 | 4s↑ = 18.9737 |
/// | 803 | 1 | −2 | 0 | 0 | 0 | 0 | 3 | 3 | 3 |
const EXAMPLE: [(f64, [f64; 2], [f64; 2]); 5] = [
    (0.0, [0.0, -3.0], [1.0, 0.0]),
    (210.0, [4.0, 2.0], [0.0, 2.0]),
    (395.0, [6.0, 7.0], [1.0, 1.0]),
    (611.0, [5.0, 5.0], [3.0, 1.0]),
    (803.0, [1.0, -2.0], [0.0, 0.0]),
];

fn example() -> Runs {
    let targets = EXAMPLE.map(|(target, _, _)| target);
    runs_of(&targets, 5, |target, direction, run| {
        let at = EXAMPLE.iter().find(|row| row.0 == target).unwrap();
        let way = usize::from(direction == Direction::Down);
        at.1[way] + at.2[way] * (f64::from(run) - 3.0)
    })
}

fn calibration(runs: &Runs) -> Calibration {
    Calibration::of(runs, &Expansion::default(), true).unwrap()
}

/// Play that an axis takes up the other way round makes all Bi negative: B is the largest by size, its mean keeps the sign.
#[test]
fn a_negative_reversal_counts_by_its_size() {
    let targets = EXAMPLE.map(|(target, _, _)| target);
    let found = calibration(&runs_of(&targets, 5, |target, direction, _| {
        let play = if target > 600.0 { 6.0 } else { 4.0 };
        if direction == Direction::Down {
            play
        } else {
            0.0
        }
    }));
    assert_near(found.axis.reversal_um, 6.0, 1e-12);
    assert_near(
        found.axis.mean_reversal_um,
        -(3.0 * 4.0 + 2.0 * 6.0) / 5.0,
        1e-12,
    );
}

#[test]
fn every_figure_is_as_by_hand() {
    let found = calibration(&example());
    let s = 2.5_f64.sqrt();
    for (target, (place, mean, scatter)) in found.targets.iter().zip(EXAMPLE) {
        assert_near(target.target_mm, place, 0.0);
        for way in [0, 1] {
            assert_near(target.mean_um[way], mean[way], 1e-12);
            assert_near(target.s_um[way], scatter[way] * s, 1e-12);
            assert_near(
                target.repeatability_one_way_um[way],
                4.0 * scatter[way] * s,
                1e-12,
            );
        }
        assert_near(target.reversal_um, mean[0] - mean[1], 1e-12);
    }
    let repeatability = [6.3246, 12.6491, 7.3246, 18.9737, 3.0];
    for (target, expected) in found.targets.iter().zip(repeatability) {
        assert_near(target.repeatability_um, expected, 5e-5);
    }
    let axis = &found.axis;
    assert_near(axis.reversal_um, 3.0, 1e-12);
    assert_near(
        axis.mean_reversal_um,
        (3.0 + 2.0 - 1.0 + 0.0 + 3.0) / 5.0,
        1e-12,
    );
    assert_near(axis.repeatability_one_way_um[0], 12.0 * s, 1e-12);
    assert_near(axis.repeatability_one_way_um[1], 8.0 * s, 1e-12);
    assert_near(axis.repeatability_um, 12.0 * s, 1e-12);
    assert_near(axis.systematic_one_way_um[0], 6.0, 1e-12);
    assert_near(axis.systematic_one_way_um[1], 10.0, 1e-12);
    assert_near(axis.systematic_um, 10.0, 1e-12);
    // Means of both: −1.5, 3, 6.5, 5, −0.5.
    assert_near(axis.mean_range_um, 8.0, 1e-12);
    // Up: 5 + 2·3s at 611 above, 5 − 6s there below; down: 7 + 2s at 395, 2 − 4s at 210.
    assert_near(axis.accuracy_one_way_um[0], 12.0 * s, 1e-12);
    assert_near(axis.accuracy_one_way_um[1], 5.0 + 2.0 * s + 4.0 * s, 1e-12);
    assert_near(axis.accuracy_um, 12.0 * s, 1e-12);
    assert_eq!((found.runs, found.length_mm), (5, 803.0));
}

#[test]
fn the_order_of_the_readings_does_not_matter() {
    let mut runs = example();
    runs.readings.reverse();
    let (one, other) = (calibration(&example()), calibration(&runs));
    assert_near(one.axis.accuracy_um, other.axis.accuracy_um, 1e-12);
    assert_eq!(one.targets.len(), other.targets.len());
}

#[test]
fn a_warm_axis_has_the_figures_of_a_cold_one() {
    // At 25 °C the screw's place is 11.5 µm/m/K·5 K farther; a glass scale at the same temperature shows 3.5 less of it.
    let expansion = Expansion {
        machine_um_per_m_k: 11.5,
        instrument_um_per_m_k: 8.0,
        datum_mm: 100.0,
        temperature_c: 20.0,
    };
    let mut warm = example();
    for (at, reading) in warm.readings.iter_mut().enumerate() {
        let temperature = 25.0 + 0.1 * f64::from((at % 7) as u32);
        reading.temperature_c = Some(temperature);
        reading.deviation_um +=
            (11.5 - 8.0) * (temperature - 20.0) * (reading.target_mm - 100.0) / 1000.0;
    }
    let found = Calibration::of(&warm, &expansion, true).unwrap();
    let cold = calibration(&example());
    for (warm, cold) in found.targets.iter().zip(&cold.targets) {
        for way in [0, 1] {
            assert_near(warm.mean_um[way], cold.mean_um[way], 1e-9);
            assert_near(warm.s_um[way], cold.s_um[way], 1e-9);
        }
    }
    assert_near(expansion.warmest(&warm), 5.6, 1e-9);
    // The sign: a screw that is warm carries too far, unreduced.
    let unreduced = Calibration::of(
        &warm,
        &Expansion {
            machine_um_per_m_k: 8.0,
            ..expansion
        },
        true,
    )
    .unwrap();
    assert!(unreduced.targets[4].mean_um[0] > cold.targets[4].mean_um[0] + 10.0);
    assert!(
        Expansion {
            machine_um_per_m_k: 51.0,
            ..expansion
        }
        .check()
        .is_err()
    );
}

#[test]
fn too_few_runs_or_targets_are_refused_by_name() {
    let mut runs = example();
    runs.readings.retain(|reading| {
        !(reading.target_mm == 395.0 && reading.direction == Direction::Down && reading.run > 3)
    });
    let error = Calibration::of(&runs, &Expansion::default(), true).unwrap_err();
    assert_eq!(
        error.to_string(),
        "target 395 mm has 3 runs down, 5 are needed: measure more"
    );
    assert_eq!(
        Calibration::of(&runs, &Expansion::default(), false)
            .unwrap()
            .runs,
        3
    );
    // 5 a metre: 1 100 mm need 6.
    let long = runs_of(&[0.0, 300.0, 500.0, 800.0, 1100.0], 5, |_, _, _| 0.0);
    let error = Calibration::of(&long, &Expansion::default(), true).unwrap_err();
    assert!(
        matches!(
            error,
            Unfit::Targets {
                targets: 5,
                needed: 6,
                ..
            }
        ),
        "{error}"
    );
    let none = Calibration::of(&Runs::default(), &Expansion::default(), false).unwrap_err();
    assert!(
        none.to_string()
            .starts_with("0 targets over 0 mm, 2 are needed"),
        "{none}"
    );
}
