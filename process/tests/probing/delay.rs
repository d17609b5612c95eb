use leadscrew_process::metrology::fitted::Settings;
use leadscrew_process::probing::delay::{SpeedTouch, find};
use proptest::prelude::*;

use crate::{Noise, cases};

fn touch(velocity_mm_per_min: f64, position_mm: f64) -> SpeedTouch {
    SpeedTouch {
        velocity_mm_per_min,
        position_mm,
    }
}

#[test]
fn two_touches_at_two_speeds_give_the_quotient_of_the_differences() {
    // 300 mm/min is 5 mm/s: 2 ms more at 480 mm/min are 6 µm.
    let found = find(
        &[touch(300.0, 10.010), touch(480.0, 10.016)],
        &Settings::default(),
    )
    .unwrap();
    assert!((found.delay_s.value - 0.002).abs() < 1e-12);
    assert!((found.contact_mm.value - 10.0).abs() < 1e-12);
    assert_eq!(found.delay_s.sigma, None, "nothing is redundant");
    assert_eq!(found.speeds.len(), 2);
}

#[test]
fn the_scatter_at_a_speed_is_twice_the_standard_deviation() {
    // ±1 µm about a mean from three touches: s² = (1 + 0 + 1)/2. A speed 1 % off is the same one.
    let touches = [
        touch(100.0, 10.001),
        touch(101.0, 10.0),
        touch(100.0, 9.999),
        touch(200.0, 10.0),
    ];
    let found = find(&touches, &Settings::default()).unwrap();
    let [slow, fast] = &found.speeds[..] else {
        panic!("{:?}", found.speeds);
    };
    assert_eq!((slow.touches, fast.touches), (3, 1));
    assert!((slow.mean_mm - 10.0).abs() < 1e-12);
    assert!((slow.two_sigma_mm.unwrap() - 0.002).abs() < 1e-12);
    assert_eq!(fast.two_sigma_mm, None);
}

#[test]
fn what_does_not_tell_a_delay_is_refused() {
    let message =
        |touches: &[SpeedTouch]| find(touches, &Settings::default()).unwrap_err().to_string();
    assert!(message(&[touch(100.0, 1.0)]).contains("needs 2 touches or more, found 1"));
    assert!(
        message(&[touch(100.0, 1.0), touch(100.0, 1.001), touch(100.0, 1.0)])
            .contains("same speed")
    );
    assert!(
        message(&[touch(100.0, 1.0), touch(-100.0, 1.0)]).contains("one surface from one side")
    );
}

#[test]
fn tables_are_read_and_complained_about() {
    let touches = SpeedTouch::read("position_mm,velocity_mm_per_min,edges\n1.5,-100,30\n").unwrap();
    assert_eq!(touches, [touch(-100.0, 1.5)]);
    let message = |text| SpeedTouch::read(text).unwrap_err().to_string();
    let missing = message("position_mm\n1\n");
    assert!(
        missing.starts_with("1:1: there is no column \"velocity_mm_per_min\""),
        "{missing}"
    );
    let empty = message("position_mm,velocity_mm_per_min\n1,\n");
    assert!(empty.starts_with("2:3: "), "{empty}");
    assert_eq!(
        message("position_mm,velocity_mm_per_min\nx,2\n"),
        "2:1: position_mm = \"x\": expected a number"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases()))]

    #[test]
    fn a_random_delay_is_recovered_within_its_sigma(
        seed in any::<u64>(),
        delay_s in 0.0..0.01_f64,
        slow in 20.0..100.0,
        ratio in 2.0..6.0,
        down in any::<bool>(),
        noise_mm in 1e-5..2e-3,
    ) {
        let mut noise = Noise::new(seed);
        let way = if down { -1.0 } else { 1.0 };
        let touches: Vec<SpeedTouch> = (0..40)
            .map(|number| {
                let speed = way * if number % 2 == 0 { slow } else { slow * ratio };
                touch(speed, 123.4 + speed / 60.0 * delay_s + noise_mm * noise.next())
            })
            .collect();
        let found = find(&touches, &Settings::default()).unwrap();
        let sigma = found.delay_s.sigma.unwrap();
        // σ of a slope between two groups of 20: σ√(2/20) over the difference of speeds.
        let expected = noise_mm * 0.1_f64.sqrt() / (slow * (ratio - 1.0) / 60.0);
        prop_assert!(sigma / expected > 0.6 && sigma / expected < 1.5);
        prop_assert!((found.delay_s.value - delay_s).abs() < 5.0 * expected);
        prop_assert!((found.contact_mm.value - 123.4).abs() < 5.0 * found.contact_mm.sigma.unwrap());
    }
}
