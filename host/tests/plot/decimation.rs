//! Thinned series show what the whole ones would.

use leadscrew_host::plot::decimate;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::examples::{Points, sampled};

fn finite(points: &[(f64, f64)]) -> Points {
    let drawn = |point: &&(f64, f64)| point.0.is_finite() && point.1.is_finite();
    points.iter().filter(drawn).copied().collect()
}

fn extremes(points: &[(f64, f64)]) -> (f64, f64) {
    points
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |ends, point| {
            (ends.0.min(point.1), ends.1.max(point.1))
        })
}

/// Ascending times with steps of different sizes, repeats among them; values with gaps.
fn series() -> impl Strategy<Value = Points> {
    let value = prop_oneof![
        20 => -1e6..1e6,
        1 => Just(f64::NAN),
        1 => Just(f64::NEG_INFINITY),
    ];
    let step = prop_oneof![3 => 0.0..0.01, 1 => 0.0..5.0, 1 => Just(0.0)];
    prop::collection::vec((step, value), 0..3000).prop_map(|samples| {
        let mut time = -3.0;
        let advance = |(step, value): (f64, f64)| {
            time += step;
            (time, value)
        };
        samples.into_iter().map(advance).collect()
    })
}

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 128,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn decimation_keeps_ends_and_envelope(points in series(), columns in 0_usize..400) {
        let whole = finite(&points);
        let thinned = decimate(&points, columns).concat();
        prop_assert!(thinned.len() <= 4 * columns.max(1));
        prop_assert_eq!(thinned.is_empty(), whole.is_empty());
        prop_assert_eq!(thinned.first().map(|p| p.0), whole.first().map(|p| p.0));
        prop_assert_eq!(thinned.last().map(|p| p.0), whole.last().map(|p| p.0));
        prop_assert_eq!(extremes(&thinned), extremes(&whole));
        prop_assert!(thinned.is_sorted_by(|a, b| a.0 <= b.0));
        prop_assert!(thinned.iter().all(|point| whole.contains(point)), "invented a point");
        if whole.len() <= 4 * columns.max(1) {
            prop_assert_eq!(thinned, whole);
        }
    }

    #[test]
    fn every_pixel_column_keeps_its_envelope(values in prop::collection::vec(-1.0..1.0, 1025)) {
        let points: Points = values.iter().enumerate().map(|(i, &y)| (i as f64, y)).collect();
        let thinned = decimate(&points, 16).concat();
        for column in 0..16 {
            let part = |all: &[(f64, f64)]| {
                let in_column = |point: &&(f64, f64)| (point.0 as usize / 64).min(15) == column;
                extremes(&all.iter().filter(in_column).copied().collect::<Points>())
            };
            prop_assert_eq!(part(&thinned), part(&points));
        }
    }
}

#[test]
fn decimation_keeps_gaps_apart() {
    let mut points = sampled(10_000, f64::sin);
    for point in &mut points[4000..5000] {
        point.1 = f64::NAN;
    }
    let runs = decimate(&points, 100);
    assert_eq!(runs.len(), 2);
    assert_eq!(runs[0].last().unwrap().0, points[3999].0);
    assert_eq!(runs[1].first().unwrap().0, points[5000].0);
    assert_eq!(
        decimate(&[(0.0, f64::NAN), (f64::NAN, 1.0)], 100),
        Vec::<Points>::new()
    );
}

#[test]
fn decimation_sorts_samples_out_of_order() {
    let points = [(2.0, 1.0), (0.0, 3.0), (f64::NAN, 9.0), (1.0, 2.0)];
    assert_eq!(
        decimate(&points, 10),
        [[(0.0, 3.0), (1.0, 2.0), (2.0, 1.0)]]
    );
}
