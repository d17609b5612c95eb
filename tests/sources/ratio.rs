//! Ratios are exact, however many counts pass.

use leadscrew::setpoint::ratio::{Carried, MAX_STEP, Ratio};
use proptest::prelude::*;

use crate::seeded::seeded;

/// A fraction that is allowed: terms up to 2²⁰, 2⁻¹⁶ to 1 024 in size.
pub fn any_fraction() -> impl Strategy<Value = (i64, i64)> {
    let term = || prop_oneof![1..100_i64, 1..=1_048_576_i64];
    (term(), term(), any::<bool>())
        .prop_map(|(over, under, negative)| (if negative { -over } else { over }, under))
        .prop_filter("size", |(over, under)| {
            let size = *over as f64 / *under as f64;
            (1.0 / 65_536.0..=1024.0).contains(&size.abs())
        })
}

pub fn ratio(over: i64, under: i64) -> Ratio {
    Ratio::new(("over", over as f64), ("under", under as f64)).unwrap()
}

/// ⌊2¹⁶·N·counts/D⌋.
fn exact(over: i64, under: i64, counts: i64) -> i64 {
    let whole = i128::from(over) * i128::from(counts) * 65_536;
    whole.div_euclid(i128::from(under)).try_into().unwrap()
}

proptest! {
    #![proptest_config(seeded(300))]

    #[test]
    fn every_sum_of_steps_is_the_exact_way_rounded_down(
        (over, under) in any_fraction(),
        steps in prop::collection::vec(-MAX_STEP..=MAX_STEP, 1..200),
    ) {
        let ratio = ratio(over, under);
        let (mut carried, mut way, mut counts) = (Carried::ZERO, 0_i64, 0_i64);
        for step in steps {
            way += ratio.step(&mut carried, step);
            counts += i64::from(step);
            prop_assert_eq!(way, exact(over, under, counts));
        }
    }

    #[test]
    fn derivatives_are_scaled_to_nearest((over, under) in any_fraction(), value in any::<i32>()) {
        let scaled = ratio(over, under).of(value) as f64;
        let wanted = f64::from(value) * over as f64 / under as f64;
        prop_assert!((scaled - wanted).abs() <= 0.51 + 1e-9 * wanted.abs(), "{scaled} for {wanted}");
    }
}

#[test]
fn a_thousand_million_counts_do_not_drift() {
    // π to 2e-7, forward; then all the way back in other steps.
    let ratio = ratio(103_993, 33_102);
    let (mut carried, mut way, mut counts) = (Carried::ZERO, 0_i64, 0_i64);
    while counts < 1_000_000_000 {
        way += ratio.step(&mut carried, 2039);
        counts += 2039;
    }
    assert_eq!(way, exact(103_993, 33_102, counts));
    while counts > 0 {
        let step = counts.min(1777);
        way += ratio.step(&mut carried, -step as i32);
        counts -= step;
    }
    assert_eq!((way, carried), (0, Carried::ZERO));
}

#[test]
fn what_is_no_ratio_is_refused_by_name() {
    let refused = |over, under| {
        Ratio::new(("over", over), ("under", under))
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        refused(0.0, 1.0),
        "over = 0 is out of range: allowed 1 to 1048576"
    );
    assert!(refused(1.5, 1.0).starts_with("over = 1.5 is out of range: allowed 2 to 2"));
    assert!(refused(f64::NAN, 1.0).starts_with("over"));
    assert!(refused(1.0, 0.0).starts_with("under"));
    assert!(refused(1.0, 2e6).starts_with("under"));
    assert!(refused(1025.0, 1.0).starts_with("d a count of the electronic gear = 1025"));
}
