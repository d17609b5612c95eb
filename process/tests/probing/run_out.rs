use std::f64::consts::PI;

use leadscrew_process::metrology::fitted::Settings;
use leadscrew_process::probing::run_out::{Along, TurnedTouch, find};
use proptest::prelude::*;

use crate::{Noise, cases};

fn touch(along: Along, angle: f64, position_mm: f64) -> TurnedTouch {
    TurnedTouch {
        surface: String::new(),
        along,
        angle,
        position_mm,
    }
}

#[test]
fn half_the_difference_over_half_a_turn_is_the_run_out() {
    let touches = [touch(Along::X, 0.0, 9.98), touch(Along::X, PI, 10.02)];
    let found = find(&touches, &Settings::default()).unwrap();
    assert!((found.x_mm.unwrap().value - 0.02).abs() < 1e-12);
    assert_eq!(found.y_mm, None);
    assert_eq!(found.radius_mm, None);
    assert!((found.surfaces[0].position_mm.value - 10.0).abs() < 1e-12);
    // The other axis has its own.
    let both = [
        &touches[..],
        &[touch(Along::Y, 0.0, 5.01), touch(Along::Y, PI, 4.99)],
    ]
    .concat();
    let found = find(&both, &Settings::default()).unwrap();
    assert!((found.y_mm.unwrap().value + 0.01).abs() < 1e-12);
    assert!((found.radius_mm.unwrap() - 0.02_f64.hypot(0.01)).abs() < 1e-12);
}

#[test]
fn a_spindle_that_was_not_turned_tells_nothing() {
    let touches = [touch(Along::X, 0.0, 9.98), touch(Along::X, 0.0, 9.99)];
    let error = find(&touches, &Settings::default())
        .unwrap_err()
        .to_string();
    assert!(error.contains("turn it by 180°"), "{error}");
}

#[test]
fn tables_are_read_and_complained_about() {
    let text = "along,angle_deg,position_mm,surface\nx,180,1.25,left\n";
    let touches = TurnedTouch::read(text).unwrap();
    assert_eq!(
        (touches[0].surface.as_str(), touches[0].position_mm),
        ("left", 1.25)
    );
    assert!((touches[0].angle - PI).abs() < 1e-12);
    let error = TurnedTouch::read("along,angle_deg,position_mm\nz,0,1\n").unwrap_err();
    assert_eq!(error.to_string(), "2:1: along = \"z\": expected x or y");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases()))]

    #[test]
    fn a_random_run_out_is_recovered_within_its_sigma(
        seed in any::<u64>(),
        x_mm in -0.1..0.1_f64,
        y_mm in -0.1..0.1_f64,
        phase in 0.0..std::f64::consts::TAU,
        noise_mm in 1e-5..2e-3,
    ) {
        let mut noise = Noise::new(seed);
        let mut touches = Vec::new();
        for turn in 0..16 {
            let angle = phase + f64::from(turn) * PI / 2.0;
            let (sine, cosine) = angle.sin_cos();
            let (at_x, at_y) = (x_mm * cosine - y_mm * sine, x_mm * sine + y_mm * cosine);
            touches.push(touch(Along::X, angle, 50.0 - at_x + noise_mm * noise.next()));
            touches.push(touch(Along::Y, angle, -7.0 - at_y + noise_mm * noise.next()));
        }
        let found = find(&touches, &Settings::default()).unwrap();
        for (value, truth) in [(found.x_mm, x_mm), (found.y_mm, y_mm)] {
            let value = value.unwrap();
            prop_assert!((value.value - truth).abs() < 5.0 * noise_mm / 4.0);
            prop_assert!(value.sigma.unwrap() < 2.0 * noise_mm / 4.0);
        }
        prop_assert!((found.surfaces[0].position_mm.value - 50.0).abs() < 5.0 * noise_mm / 4.0);
    }
}
