//! The largest frequency over radii and feeds against brute force.

use leadscrew_process::plan::cycle::frequency_hz;
use leadscrew_process::plan::{Kinematics, Limit};
use proptest::prelude::*;

use super::{assert_near, axis_of};

/// The largest frequency over a fine mesh of radii and, on each, of feeds; the radius where it is.
fn by_brute_force(axis: &Kinematics, allowed_d: f64) -> (f64, f64) {
    let k = axis.counts_per_mm();
    let speed = axis.max_feed_mm_per_min() / 60.0;
    let feed_by_limits = |radius: f64| {
        let by_acceleration = (1000.0 * axis.max_acceleration_m_s2() * radius).sqrt();
        let by_jerk = axis.max_jerk_m_s3().map_or(f64::INFINITY, |jerk| {
            (1000.0 * jerk * radius * radius).cbrt()
        });
        60.0 * speed.min(by_acceleration).min(by_jerk)
    };
    let from = (allowed_d / k).ln();
    let to = (1e7_f64).ln();
    let mut best = (0.0, 0.0);
    let steps = 40_000;
    for at in 0..=steps {
        let radius = (from + (to - from) * f64::from(at) / f64::from(steps)).exp();
        for share in [0.25, 0.5, 0.75, 0.999, 1.0] {
            let frequency = frequency_hz(share * feed_by_limits(radius), radius, k, allowed_d);
            if frequency > best.0 {
                best = (frequency, radius);
            }
        }
    }
    best
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_analytic_maximum_is_the_largest_there_is(
        feed in (1.0..5.5_f64).prop_map(|x| 10_f64.powf(x)),
        acceleration in (-3.0..2.5_f64).prop_map(|x| 10_f64.powf(x)),
        jerk in prop::option::of((-2.0..4.0_f64).prop_map(|x| 10_f64.powf(x))),
        k in (1.0..5.5_f64).prop_map(|x| 10_f64.powf(x)),
        allowed in 0.25..4.0_f64,
    ) {
        let axis = Kinematics::new(feed, acceleration, jerk, k).unwrap();
        let cycle = axis.rational_cycle(allowed).unwrap();
        let (found, radius) = by_brute_force(&axis, allowed);
        // The mesh does not pass it, and comes as near as it is fine.
        prop_assert!(found <= cycle.frequency_hz * (1.0 + 1e-9), "{found} at R {radius}: {cycle:?}");
        prop_assert!(found >= cycle.frequency_hz * 0.999, "{found} at R {radius}: {cycle:?}");
    }
}

#[test]
fn jerk_rules_where_the_feed_is_reached_before_the_crossover() {
    // The paper's 1 g and 50 m/s³: at 100 m/min the jerk holds the axis below 1 107 Hz.
    let cycle = axis_of(1e5, 1.0, Some(50.0), 1000.0)
        .rational_cycle(1.0)
        .unwrap();
    assert_eq!(cycle.ruled_by, Limit::Jerk);
    assert_near(cycle.radius_mm, 304.3, 0.1);
    assert_near(cycle.frequency_hz, 1068.0, 1.0);
    assert!(cycle.frequency_hz < cycle.closed_form_hz);
}

#[test]
fn without_a_jerk_the_smallest_circle_asks_for_most() {
    // Of one discrete: √2 times the closed form.
    let cycle = axis_of(1e5, 1.0, None, 1000.0).rational_cycle(1.0).unwrap();
    assert_near(cycle.radius_mm, 0.001, 1e-12);
    assert_near(
        cycle.frequency_hz,
        2_f64.sqrt() * cycle.closed_form_hz,
        1e-6,
    );
}

#[test]
fn of_several_axes_the_largest_of_everything_counts() {
    let axes = [
        axis_of(30_000.0, 0.2, Some(5.0), 1000.0),
        axis_of(20_000.0, 0.3, Some(50.0), 500.0),
    ];
    let largest = Kinematics::largest(&axes).unwrap();
    assert_eq!(largest, axis_of(30_000.0, 0.3, Some(50.0), 1000.0));
    assert!(Kinematics::largest(&[]).is_none());
    let unwatched = axis_of(1.0, 0.1, None, 1.0);
    assert_eq!(
        Kinematics::largest(&[largest, unwatched])
            .unwrap()
            .max_jerk_m_s3(),
        None
    );
}
