//! The origin is the same whatever the speed, the start and the noise.

use leadscrew::homing::{HomingParams, Stage};

use crate::rig::{Rig, Switches, real};

fn params(search: f64, approach: f64) -> HomingParams {
    HomingParams {
        search_feed_mm_per_min: search,
        approach_feed_mm_per_min: approach,
        ..HomingParams::default()
    }
}

#[test]
fn the_origin_is_the_same_at_every_speed_and_for_every_seed() {
    for seed in 1..=5 {
        for (search, approach) in [
            (600.0, 60.0),
            (1000.0, 120.0),
            (3000.0, 600.0),
            (6000.0, 2400.0),
        ] {
            let mut rig = Rig::new(
                &real(),
                params(search, approach),
                Switches::at(33_000.0),
                seed,
            );
            rig.home();
            let origin = rig
                .origin()
                .unwrap_or_else(|| panic!("{:?}", rig.axis.homing().failure()));
            assert!(
                (origin - 40_000.0).abs() <= 1.0,
                "{origin} at {search} mm/min, seed {seed}"
            );
            let distance = rig.axis.homing().index_distance().unwrap();
            // The switch stands by the shaft, the index by the disc, some 2 d out of centre.
            assert!((6_996..=7_004).contains(&distance), "{distance}");
        }
    }
}

#[test]
fn downwards_the_index_is_that_of_the_other_front_and_as_repeatable() {
    // A cam that ends at −33 000; the pulse is 3 d wide and passed from above.
    let switches = Switches {
        home: (-53_000.0, -33_000.0),
        ..Switches::at(0.0)
    };
    for seed in 1..=3 {
        for (search, approach) in [(600.0, 60.0), (3000.0, 600.0)] {
            let params = HomingParams {
                search_direction: -1.0,
                ..params(search, approach)
            };
            let mut rig = Rig::new(&real(), params, switches, seed);
            rig.home();
            let origin = rig.origin().unwrap();
            assert!(
                (origin + 39_997.0).abs() <= 1.0,
                "{origin} at {search} mm/min, seed {seed}"
            );
        }
    }
}

#[test]
fn every_start_comes_to_the_same_origin() {
    let before = Switches::at(33_000.0);
    // Starts on the switch: its cam began behind.
    let on = Switches {
        home: (-7000.0, 13_000.0),
        ..before
    };
    let at_its_end = Switches {
        home: (-17_000.0, 500.0),
        ..before
    };
    // Starts beyond it, and finds the limit.
    let beyond = Switches {
        home: (-47_000.0, -27_000.0),
        limits: (-500_000.0, 30_000.0),
    };
    for (name, switches, expected) in [
        ("before", before, 40_000.0),
        ("on", on, 0.0),
        ("at its end", at_its_end, -10_000.0),
        ("beyond", beyond, -40_000.0),
    ] {
        for latches in [true, false] {
            let mut rig = Rig::new(&real(), HomingParams::default(), switches, 3);
            rig.latches = latches;
            rig.home();
            let origin = rig.origin();
            assert!(
                origin.is_some_and(|origin| (origin - expected).abs() <= 1.0),
                "{name}: {origin:?} {:?}",
                rig.axis.homing().failure()
            );
            assert_eq!(rig.axis.homing().stage(), Stage::Idle);
        }
    }
}

#[test]
fn the_index_has_the_coordinate_that_is_set() {
    let homing = HomingParams {
        home_position_mm: -12.5,
        ..HomingParams::default()
    };
    let mut rig = Rig::new(&real(), homing, Switches::at(33_000.0), 1);
    rig.home();
    // Encoder 40 000 is −12.5 mm.
    assert!((rig.origin().unwrap() - 52_500.0).abs() <= 1.0);
    let outputs = rig.outputs;
    let place = outputs.count as f64 + 0.5 - rig.origin().unwrap();
    assert_eq!(outputs.reported.to_num::<f64>(), place);
    let (index, half_a_turn) = (-12_500.0, 5000.0);
    assert!((index..index + half_a_turn).contains(&place), "{place}");
}
