//! Full rotations bound the error of small angles.

use leadscrew_nc::coordinates::Axis;
use leadscrew_process::deviations::{Machine, SettingVector};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

use crate::machines::{bare, five_axes, machine, place, settings, with_constants};

fn cases() -> ProptestConfig {
    let long = std::env::var_os("LEADSCREW_LONG").is_some();
    ProptestConfig::with_cases(if long { 20_000 } else { 400 })
}

fn difference(
    bare: Machine,
    settings: &[SettingVector],
    parts: &[f64],
) -> (f64, f64, f64, SettingVector) {
    let machine = with_constants(bare, settings);
    let at = place(&machine, parts);
    let small = machine.deviation(&at).unwrap();
    let exact = machine.exact_deviation(&at).unwrap();
    let bound = machine.small_angle_bound_mm(&at).unwrap();
    let theta: f64 = settings.iter().map(|one| one.turn.norm()).sum();
    let off = small - exact;
    (off.shift.norm(), bound, theta, off)
}

proptest! {
    #![proptest_config(cases())]

    /// From errors as machines have them to a hundred times as large.
    #[test]
    fn the_small_angle_sum_is_within_its_bound(
        number in 0_usize..2,
        settings in prop::collection::vec(settings(0.05, 1e-4), 5),
        scale in 1.0..100.0,
        parts in prop::array::uniform4(0.0..=1.0),
    ) {
        let settings: Vec<_> = settings.into_iter().map(|one| one * scale).collect();
        let (off, bound, theta, turns) = difference(bare(number), &settings, &parts);
        prop_assert!(off <= bound, "{off} mm, bound {bound} mm");
        prop_assert!(turns.turn.norm() <= 0.5 * theta * theta * theta.exp());
    }

    /// Where a rotary axis carries another one, the deviations of the latter go round with the former.
    #[test]
    fn the_small_angle_sum_follows_a_rotary_axis_that_carries_another(
        settings in prop::collection::vec(settings(0.05, 1e-4), 5),
        parts in prop::array::uniform5(0.0..=1.0),
    ) {
        let (off, bound, theta, turns) = difference(five_axes(), &settings, &parts);
        prop_assert!(off <= bound, "{off} mm, bound {bound} mm");
        prop_assert!(turns.turn.norm() <= 0.5 * theta * theta * theta.exp());
    }

    /// The library's frames against ones written out here for the arrangement of the 6904MF2.
    #[test]
    fn the_frames_of_the_machining_centre_are_those_written_out(
        settings in prop::collection::vec(settings(0.05, 1e-3), 5),
        parts in prop::array::uniform4(0.0..=1.0),
    ) {
        let machine = with_constants(bare(0), &settings);
        let at = place(&machine, &parts);
        let shifted = |x, y, z| Isometry3::from(Translation3::new(x, y, z));
        let omega = |i: usize| Isometry3::from_parts(
            Translation3::from(settings[i].shift),
            UnitQuaternion::from_scaled_axis(settings[i].turn),
        );
        let turned = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -at[Axis::B].to_radians());
        let workpiece = shifted(0.0, -400.0, -at[Axis::Z]) * omega(0)
            * shifted(-at[Axis::X], 150.0, 0.0) * omega(1)
            * shifted(0.0, 250.0, 0.0) * omega(2) * turned;
        let tool = shifted(0.0, at[Axis::Y], 700.0) * omega(3)
            * shifted(0.0, 0.0, -300.0) * omega(4) * shifted(0.0, 0.0, -150.0);
        let found = machine.true_tip(&at).unwrap();
        let expected = workpiece.inverse() * tool;
        prop_assert!((found.translation.vector - expected.translation.vector).norm() < 1e-9);
        prop_assert!(found.rotation.angle_to(&expected.rotation) < 1e-7);
    }
}

/// The bound is no empty one: a turn across a long way uses half of it and more.
#[test]
fn the_bound_is_tight_within_a_factor_of_two() {
    let turn = SettingVector::new([0.0, 0.0, 0.0, 0.0, 0.0, 1e-3]);
    let mut settings = vec![SettingVector::ZERO; 5];
    settings[3] = turn;
    let (off, bound, ..) = difference(bare(0), &settings, &[0.5, 1.0, 0.5, 0.0]);
    // The tip lies 450 mm from the spindle head's frame, along z: a turn about z moves nothing, one about x does.
    assert!(off < 1e-12 * bound, "{off} of {bound}");
    settings[3] = SettingVector::new([0.0, 0.0, 0.0, 1e-3, 0.0, 0.0]);
    let (off, bound, ..) = difference(bare(0), &settings, &[0.5, 1.0, 0.5, 0.0]);
    assert!(off > 0.5 * bound && off <= bound, "{off} of {bound}");
}

/// As large as the deviations of real machines are, small angles err by nanometres.
#[test]
fn the_built_in_machines_are_small_enough() {
    for name in ["6904MF2", "lathe"] {
        let machine = machine(name);
        let map = machine
            .map(&Default::default(), machine.evenly(&[], 4))
            .unwrap();
        let worst = map.extreme(|point| {
            (point.delta - machine.exact_deviation(&point.at).unwrap())
                .shift
                .norm()
        });
        assert!(worst.value < 1e-5, "{name}: {} mm", worst.value);
        assert!(worst.value > 0.0, "{name}: nothing deviates");
    }
}
