//! Setting vectors are recovered from simulated indicators.

use leadscrew_process::deviations::{
    Component, Indicator, Motion, Readings, SettingVector, Stand, direction_of,
};
use nalgebra::{Isometry3, Point3, Vector3};
use proptest::prelude::*;

use crate::machines::settings;

const SIZE_MM: f64 = 300.0;

fn along(text: &str) -> Motion {
    Motion::Linear(direction_of(text).unwrap())
}

/// P4's five, for a table along z.
fn five() -> Vec<Indicator> {
    let at = |name: &str, place: [f64; 3], direction| Indicator {
        name: name.to_owned(),
        place_mm: Vector3::from(place),
        direction: direction_of(direction).unwrap(),
    };
    vec![
        at("1", [-200.0, 0.0, -150.0], "+y"),
        at("2", [200.0, 0.0, -150.0], "+y"),
        at("3", [0.0, 0.0, 200.0], "-y"),
        at("4", [-250.0, -50.0, -150.0], "+x"),
        at("5", [-250.0, -50.0, 150.0], "+x"),
    ]
}

/// What an indicator reads where the place it touches is displaced with a full rotation.
fn reading(indicator: &Indicator, place: Vector3<f64>, omega: &SettingVector) -> f64 {
    let motion: Isometry3<f64> = omega.to_isometry();
    let moved = motion * Point3::from(place);
    indicator.direction.dot(&(moved.coords - place))
}

fn ridden(indicators: Vec<Indicator>, omegas: &[SettingVector]) -> Readings {
    let row = |omega| {
        indicators
            .iter()
            .map(|one| reading(one, one.place_mm, omega))
            .collect()
    };
    Readings {
        places: (0..omegas.len()).map(|i| 100.0 * i as f64).collect(),
        readings_mm: omegas.iter().map(row).collect(),
        stand: Stand::Unit,
        indicators,
        sigma_mm: None,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// P4's five indicators give b, λ, γ, a, β to the second order of the turns; c is left to the drive's own measurement.
    #[test]
    fn five_indicators_give_five_parameters(
        omegas in prop::collection::vec(settings(0.02, 1e-4), 2..6),
    ) {
        let measured = ridden(five(), &omegas).solve(&along("-z")).unwrap();
        let found = [Component::A, Component::B, Component::Lambda, Component::Beta, Component::Gamma];
        prop_assert_eq!(&measured.components, &found.to_vec());
        prop_assert!(measured.sigma.is_none());
        for (omega, value) in omegas.iter().zip(measured.table.values()) {
            let theta = omega.turn.norm();
            let off = value.with(Component::C, omega.shift.z) - *omega;
            // ½θ² at places up to 300 mm away; the fit enlarges it by up to 4 in places of a frame beside the indicators.
            let bound = 4.0 * 0.5 * theta * theta * SIZE_MM;
            prop_assert!(off.shift.norm() <= bound, "{} mm", off.shift.norm());
            prop_assert!(off.turn.norm() <= bound / 100.0, "{} rad", off.turn.norm());
            prop_assert_eq!(value.shift.z, 0.0);
        }
    }

    /// On the machine, the table slides under the indicators: the places on it move with the coordinate.
    #[test]
    fn indicators_on_the_machine_touch_other_places(
        omegas in prop::collection::vec(settings(0.02, 1e-5), 3),
    ) {
        let mut readings = ridden(five(), &omegas);
        readings.stand = Stand::Machine;
        let along_z = along("+z");
        for ((row, omega), z) in readings.readings_mm.iter_mut().zip(&omegas).zip(&readings.places) {
            *row = readings
                .indicators
                .iter()
                .map(|one| reading(one, one.place_mm - Vector3::z() * *z, omega))
                .collect();
        }
        let measured = readings.solve(&along_z).unwrap();
        for (omega, value) in omegas.iter().zip(measured.table.values()) {
            let off = value.with(Component::C, omega.shift.z) - *omega;
            prop_assert!(off.shift.norm() < 1e-6 && off.turn.norm() < 1e-9, "{off:?}");
        }
    }

    /// A laser along the drive gives c at the frame, whatever the turns do to its line; a seventh indicator leaves residuals, and
    /// these tell σ.
    #[test]
    fn more_indicators_than_needed_tell_what_they_are_worth(
        omega in settings(0.02, 1e-5),
        noise in prop::collection::vec(prop::array::uniform7(-1e-3..1e-3), 40),
    ) {
        let mut indicators = five();
        for (name, place, direction) in [("6", [0.0, 300.0, 0.0], "+z"), ("7", [100.0, 100.0, 100.0], "+x")] {
            indicators.push(Indicator {
                name: name.to_owned(),
                place_mm: Vector3::from(place),
                direction: direction_of(direction).unwrap(),
            });
        }
        let mut readings = ridden(indicators, &vec![omega; noise.len()]);
        for (row, noise) in readings.readings_mm.iter_mut().zip(&noise) {
            row.iter_mut().zip(noise).for_each(|(reading, noise)| *reading += noise);
        }
        let measured = readings.solve(&along("-z")).unwrap();
        prop_assert_eq!(measured.components.len(), 6);
        let sigma = measured.sigma.unwrap();
        // Uniform noise of ±1 µm has σ = 0.577 µm; 40 spare readings tell it to ±40 %.
        let count = noise.len() as f64;
        for (component, sigma) in measured.components.iter().zip(&sigma) {
            let mean: f64 = measured.table.values().iter().map(|one| one.get(*component)).sum::<f64>() / count;
            let off = (mean - omega.get(*component)).abs();
            prop_assert!(off < 5.0 * sigma / count.sqrt(), "{component}: {off}, 1σ {sigma}");
        }
        let told = measured.residuals_mm.iter().flatten().map(|r| r * r).sum::<f64>() / count;
        prop_assert!((0.3e-3..0.85e-3).contains(&told.sqrt()), "σ of a reading {} mm", told.sqrt());
    }
}

#[test]
fn places_that_cannot_tell_parameters_apart_are_refused() {
    let mut in_line = five();
    in_line[2].place_mm.z = -150.0;
    let error = ridden(in_line, &[SettingVector::ZERO; 2])
        .solve(&along("-z"))
        .unwrap_err();
    assert!(
        error.contains('b') && error.contains('λ') && error.contains("cannot be told"),
        "{error}"
    );
    let four = five()[..4].to_vec();
    let error = ridden(four, &[SettingVector::ZERO; 2])
        .solve(&along("-z"))
        .unwrap_err();
    assert!(
        error.contains("4 indicators for a, b, λ, β, γ: 5 are needed"),
        "{error}"
    );
}

#[test]
fn readings_that_do_not_fit_are_refused() {
    let mut short = ridden(five(), &[SettingVector::ZERO; 3]);
    short.readings_mm[1].pop();
    assert!(short.solve(&along("-z")).unwrap_err().contains("row 2"));
    short.readings_mm.pop();
    assert!(
        short
            .solve(&along("-z"))
            .unwrap_err()
            .contains("2 rows of readings for 3")
    );
    let about_y = Motion::Rotary(direction_of("y").unwrap());
    let riding = ridden(five(), &[SettingVector::ZERO; 2]);
    assert!(
        riding
            .solve(&about_y)
            .unwrap_err()
            .contains("stand on the machine")
    );
}
