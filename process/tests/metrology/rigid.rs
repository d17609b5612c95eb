//! Displaced parts, touched exactly: the displacement comes back within what small angles drop.

use leadscrew_process::metrology::bore::Diameters;
use leadscrew_process::metrology::relations::{self, Placed, TableTurn};
use leadscrew_process::metrology::setting;
use leadscrew_process::metrology::{Axis, Nominal, Settings, Touch, bore, circle, plane, shoulder};
use leadscrew_process::setting_vector::SettingVector;
use nalgebra::Rotation3;
use proptest::prelude::*;

use crate::support::{around, assert_all_near, assert_near, face, touch_cylinder, touch_plane, v};

const SIZE: f64 = 200.0;
const LARGEST_ANGLE: f64 = 2e-3;
const LARGEST_SHIFT: f64 = 0.3;

fn displacement() -> impl Strategy<Value = SettingVector> {
    let shift = prop::array::uniform3(-LARGEST_SHIFT..LARGEST_SHIFT);
    let rotation = prop::array::uniform3(-LARGEST_ANGLE..LARGEST_ANGLE);
    (shift, rotation).prop_map(|(shift, turn)| SettingVector {
        shift: v(shift),
        turn: v(turn),
    })
}

fn axis() -> impl Strategy<Value = Axis> {
    prop::sample::select(Axis::ALL.to_vec())
}

/// Largest rotation of a displacement, rad.
fn angle(displaced: &SettingVector) -> f64 {
    displaced.turn.norm()
}

/// What first-order formulas drop of a length: angle² · size and angle · shift.
fn dropped(displaced: &SettingVector) -> f64 {
    2.0 * angle(displaced) * (angle(displaced) * SIZE + displaced.shift.norm())
}

fn bore_of(axis: Axis, displaced: &SettingVector, nominal: &Nominal) -> Vec<Touch> {
    assert_eq!(axis, nominal.axis);
    let places = [10.0, 60.0, 100.0]
        .into_iter()
        .flat_map(|height| around(6).map(move |angle| (height, angle)));
    places
        .map(|place| touch_cylinder(displaced, nominal, place, true, 0.02))
        .collect()
}

/// The rotation without its part about an axis.
fn across(rotation: [f64; 3], axis: Axis) -> [f64; 3] {
    let mut across = rotation;
    across[axis.index()] = 0.0;
    across
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if std::env::var_os("LEADSCREW_LONG").is_some() { 5000 } else { 150 }))]

    #[test]
    fn a_plane_tells_how_the_part_lies(displaced in displacement(), normal in axis(), height in -100.0..100.0) {
        let touches: Vec<Touch> = face(normal, height, SIZE, 4).into_iter()
            .map(|(at, normal)| touch_plane(&displaced, at, normal)).collect();
        let fitted = plane::fit(&touches, &Settings::default()).unwrap();
        assert_all_near(fitted.value.rotation, across(displaced.turn.into(), normal), 2.0 * angle(&displaced).powi(2));
        assert_near(fitted.value.offset_mm, displaced.shift[normal.index()], dropped(&displaced));
        // A plane stays a plane.
        assert_near(fitted.quality.peak_to_valley_mm(), 0.0, 1e-11);
    }

    #[test]
    fn a_shoulder_tells_how_the_part_lies(displaced in displacement(), normal in axis(), nearer in any::<bool>()) {
        let along = if nearer { normal.next() } else { normal.next().next() };
        let touches: Vec<Touch> = (-2..=3).map(|index| {
            let mut at = [0.0; 3];
            at[along.index()] = f64::from(index) * 30.0;
            touch_plane(&displaced, at, normal.unit())
        }).collect();
        let fitted = shoulder::fit(&touches, along, &Settings::default()).unwrap().value;
        assert_near(fitted.turn, displaced.turn[fitted.about.index()], 2.0 * angle(&displaced).powi(2));
        assert_near(fitted.offset_mm, displaced.shift[normal.index()], dropped(&displaced));
    }

    #[test]
    fn a_hole_tells_where_its_centre_is(displaced in displacement(), axis in axis(), count in 3_usize..9) {
        let nominal = Nominal::straight(axis, [20.0, -10.0, 30.0], 50.0);
        let touches: Vec<Touch> = around(count).map(|angle| touch_cylinder(&displaced, &nominal, (0.0, angle), true, -0.03)).collect();
        let fitted = circle::fit(&nominal, &touches, &Settings::default()).unwrap().value;
        let moved = across(displaced.displacement_of(nominal.centre_mm), axis);
        // The section of a tilted cylinder: an ellipse, its centre moved by the tilt times the shift along the axis.
        let bound = angle(&displaced) * (LARGEST_SHIFT * 2.0 + angle(&displaced) * SIZE);
        assert_all_near(fitted.centre_mm, moved, bound);
        assert_near(fitted.diameter_mm, -0.06, 50.0 * angle(&displaced).powi(2));
    }

    #[test]
    fn an_axis_tells_how_the_part_lies_and_its_diameter_exactly(displaced in displacement(), axis in axis()) {
        let nominal = Nominal::straight(axis, [20.0, -10.0, 30.0], 50.0);
        let touches = bore_of(axis, &displaced, &nominal);
        let fitted = bore::fit(&nominal, &touches, Diameters::Cylinder, &Settings::default()).unwrap();
        assert_all_near(fitted.value.rotation, across(displaced.turn.into(), axis), 2.0 * angle(&displaced).powi(2));
        assert_all_near(fitted.value.offset_mm, across(displaced.displacement_of(nominal.centre_mm), axis), dropped(&displaced));
        assert_near(fitted.value.sections[0][1], 0.04, 1e-10);
        assert_near(fitted.quality.peak_to_valley_mm(), 0.0, 1e-10);
    }

    #[test]
    fn a_rigid_rotation_of_a_perfect_part_turns_all_features_alike(rotation in prop::array::uniform3(-1e-3..1e-3), axis in axis()) {
        let displaced = SettingVector { turn: v(rotation), ..SettingVector::ZERO };
        let second_order = 4.0 * angle(&displaced).powi(2);
        let nominal = Nominal::straight(axis, [0.0; 3], 50.0);
        let bore = bore::fit(&nominal, &bore_of(axis, &displaced, &nominal).iter().map(|touch| touch.with_sigma(1e-3)).collect::<Vec<_>>(),
            Diameters::OfSections, &Settings::default()).unwrap();
        let faces = Axis::ALL.map(|normal| {
            let touches: Vec<Touch> = face(normal, 25.0, SIZE, 3).into_iter()
                .map(|(at, normal)| touch_plane(&displaced, at, normal)).collect();
            plane::fit(&touches, &Settings::default()).unwrap()
        });
        for normal in Axis::ALL {
            assert_all_near(faces[normal.index()].value.rotation, across(rotation, normal), second_order);
            assert_near(faces[normal.index()].quality.peak_to_valley_mm(), 0.0, 1e-11);
        }
        assert_all_near(bore.value.rotation, across(rotation, axis), second_order);
        let square = relations::perpendicularity((&nominal, &bore), &faces[axis.index()]).unwrap();
        assert_all_near(square.value, [0.0; 3], 1e-3 * second_order + 1e-8);
    }

    #[test]
    fn holes_are_coaxial_across_a_turn_of_the_table(
        displaced in displacement(), offset in prop::array::uniform3(-0.05..0.05),
        pivot in prop::array::uniform3(-0.1..0.1), about in axis(), other in any::<bool>(),
    ) {
        // Holes along an axis that the table's is square to; the second one off by `offset`.
        let axis = if other { about.next() } else { about.next().next() };
        let small = SettingVector { turn: displaced.turn * 0.1, ..displaced };
        let mut far = [20.0, -10.0, 30.0];
        far[axis.index()] += 150.0;
        let first = Nominal::straight(axis, [20.0, -10.0, 30.0], 50.0);
        let second = Nominal::straight(axis, far, 40.0);
        let near: Vec<Touch> = around(4).map(|angle| touch_cylinder(&small, &first, (0.0, angle), true, 0.0)).collect();
        // After the turn: planned places turn about the planned pivot, true ones about the true one.
        let turn = TableTurn { about, pivot_mm: [5.0, 6.0, 7.0], pivot_offset_mm: pivot, pivot_sigma_mm: [0.0; 3] };
        let after = Nominal { centre_mm: turn.turned(far), ..second };
        let half = Rotation3::from_scaled_axis(v(about.unit()) * std::f64::consts::PI);
        let true_pivot = v(turn.pivot_mm) + v(pivot);
        let true_centre = v(small.moved(far)) + v(across(offset, axis));
        let seen_centre = half * (true_centre - true_pivot) + true_pivot;
        let seen = SettingVector { shift: v(across((seen_centre - v(after.centre_mm)).into(), axis)), ..SettingVector::ZERO };
        let seen_touches: Vec<Touch> = around(4).map(|angle| touch_cylinder(&seen, &after, (0.0, angle), true, 0.0)).collect();
        let settings = Settings::default();
        let (near, far_circle) = (circle::fit(&first, &near, &settings).unwrap(), circle::fit(&after, &seen_touches, &settings).unwrap());
        let coaxial = relations::coaxiality(
            Placed { nominal: &first, circle: &near }, Placed { nominal: &after, circle: &far_circle }, Some(&turn)).unwrap().value;
        let expected = v(small.moved(first.centre_mm)) - (true_centre - v(far) + v(first.centre_mm));
        let bound = angle(&small) * (LARGEST_SHIFT * 3.0 + angle(&small) * SIZE) + 1e-9;
        assert_all_near(coaxial.offset_mm, across(expected.into(), axis), bound);
        assert_near(coaxial.eccentricity_mm, v(across(expected.into(), axis)).norm(), 2.0 * bound);
        let turned_by_offset = v(axis.unit()).cross(&(v(across(offset, axis)) / 150.0));
        let rotation = v(across(small.turn.into(), axis)) + turned_by_offset;
        assert_all_near(coaxial.rotation, rotation.into(), bound / 50.0);
    }

    #[test]
    fn a_setting_comes_back_exactly_from_flat_faces(displaced in displacement()) {
        let touches: Vec<Touch> = Axis::ALL.into_iter().flat_map(|normal| face(normal, 20.0, SIZE, 3))
            .map(|(at, normal)| touch_plane(&displaced, at, normal)).collect();
        let fitted = setting::fit(&touches, [true; 6], &Settings::default()).unwrap();
        assert_all_near(fitted.value.shift.into(), displaced.shift.into(), 1e-10);
        assert_all_near(fitted.value.turn.into(), displaced.turn.into(), 1e-12);
        assert_near(fitted.quality.peak_to_valley_mm(), 0.0, 1e-10);
    }

    #[test]
    fn a_turned_part_tells_diameter_taper_and_axis(
        shift in -0.1..0.1, tilt in -1e-3..1e-3, diameter in -0.1..0.1, taper in -1e-3..1e-3, planned_taper in -0.05..0.05,
    ) {
        let nominal = Nominal { taper: planned_taper, ..Nominal::straight(Axis::Z, [0.0; 3], 80.0) };
        let touch = |z: f64, side: f64, tilts: bool| {
            let radius = 40.0 + planned_taper / 2.0 * z;
            let axis = if tilts { shift + tilt * z } else { 0.0 };
            let found = axis + side * (radius + diameter / 2.0 + taper / 2.0 * z);
            Touch::at([side * radius, 0.0, z], [side, 0.0, 0.0], [found, 0.0, z])
        };
        let places = [-5.0, -40.0, -100.0];
        let both: Vec<Touch> = places.iter().flat_map(|&z| [touch(z, 1.0, true), touch(z, -1.0, true)]).collect();
        let fitted = bore::fit_turned(&nominal, &both, &Settings::default()).unwrap().value;
        assert_all_near(fitted.offset_mm, [shift, 0.0, 0.0], 1e-11);
        assert_all_near(fitted.rotation, [0.0, tilt, 0.0], 1e-13);
        assert_near(fitted.taper.unwrap(), taper, 1e-12);
        assert_near(fitted.sections[2][1], diameter + taper * -5.0, 1e-11);
        let one_side: Vec<Touch> = places.iter().map(|&z| touch(z, 1.0, false)).collect();
        let fitted = bore::fit_turned(&nominal, &one_side, &Settings::default()).unwrap().value;
        assert_near(fitted.taper.unwrap(), taper, 1e-12);
        assert_near(fitted.sections[0][1], diameter + taper * -100.0, 1e-11);
        assert_eq!(fitted.seen, [false; 3]);
        let single = bore::fit_turned(&nominal, &one_side[..1], &Settings::default()).unwrap().value;
        assert_near(single.sections[0][1], diameter + taper * -5.0, 1e-12);
    }
}
