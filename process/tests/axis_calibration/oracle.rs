//! Random axes whose errors are known.

use leadscrew_process::axis_calibration::{Calibration, Direction, ErrorTable, Expansion};
use proptest::prelude::*;

use crate::{assert_near, runs_of};

/// Targets at random offsets in equal parts of a travel.
fn targets(offsets: &[f64], travel_mm: f64) -> Vec<f64> {
    let share = travel_mm / offsets.len() as f64;
    (0..)
        .zip(offsets)
        .map(|(at, offset)| share * (f64::from(at) + offset))
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn mean_errors_backlash_and_noise_are_recovered(
        offsets in prop::collection::vec(0.1..0.9_f64, 10),
        slope in -40.0..40.0_f64,
        wave in 0.0..8.0_f64,
        backlash in 0.0..10.0_f64,
        noise in 0.1..3.0_f64,
        draws in prop::collection::vec(-1.0..1.0_f64, 2 * 10 * 12),
    ) {
        let targets = targets(&offsets, 700.0);
        // Play: the carriage stays behind, either way by half.
        let truth = |target: f64, direction: Direction| {
            let play = if direction == Direction::Up { -0.5 } else { 0.5 };
            slope * target / 1000.0 + wave * (target / 30.0).sin() + play * backlash
        };
        let mut draws = draws.into_iter();
        let runs = runs_of(&targets, 12, |target, direction, _| {
            truth(target, direction) + noise * draws.next().unwrap()
        });
        let found = Calibration::of(&runs, &Expansion::default(), true).unwrap();
        // Uniform noise ±a has σ = a/√3; the mean of 12 is within 5σ/√12 but for 1 in 10⁶.
        let sigma = noise / 3_f64.sqrt();
        let of_mean = 5.0 * sigma / 12_f64.sqrt();
        for target in &found.targets {
            for (way, direction) in Direction::BOTH.into_iter().enumerate() {
                assert_near(target.mean_um[way], truth(target.target_mm, direction), of_mean);
            }
            assert_near(target.reversal_um, -backlash, 2_f64.sqrt() * of_mean);
        }
        // Over 20 estimates of s², 220 degrees of freedom: σ(s²)/σ² of a uniform law is √((0.8 + 2/11)/240) = 0.064.
        let variance = found.targets.iter().flat_map(|target| target.s_um).map(|s| s * s).sum::<f64>() / 20.0;
        assert_near(variance, sigma * sigma, 5.0 * 0.064 * sigma * sigma);
        assert_near(found.axis.mean_reversal_um, -backlash, 5.0 * sigma * (2.0 / 120_f64).sqrt());
        // What holds whatever was drawn.
        let axis = &found.axis;
        prop_assert!(axis.accuracy_um >= axis.systematic_um && axis.systematic_um >= axis.mean_range_um);
        prop_assert!(axis.repeatability_um >= axis.reversal_um.max(axis.repeatability_one_way_um[0]));
        for way in [0, 1] {
            prop_assert!(axis.accuracy_um >= axis.accuracy_one_way_um[way]);
            prop_assert!(axis.systematic_um >= axis.systematic_one_way_um[way]);
        }
    }

    #[test]
    fn a_table_survives_its_file_and_the_board(
        points in prop::collection::vec((0.1..50.0_f64, -200.0..200.0_f64, -200.0..200.0_f64), 2..256),
        counts_per_mm in 100.0..10_000.0_f64,
    ) {
        let mut place = -300.0;
        let mut table = ErrorTable::default();
        for (step, forward, backward) in points {
            // As steep as 0.05 at most.
            place += step + 10.0;
            table.points.push(leadscrew_process::axis_calibration::ErrorPoint {
                position_mm: place,
                error_um: [forward / 2.0, backward / 2.0],
            });
        }
        let read = ErrorTable::read(&table.to_csv()).unwrap();
        let stored = read.to_stored(counts_per_mm).unwrap();
        prop_assert_eq!(stored.len(), 16 * table.points.len());
        prop_assert!(ErrorTable::of_stored(&stored[1..], counts_per_mm).is_err());
        let back = ErrorTable::of_stored(&stored, counts_per_mm).unwrap();
        for (one, other) in table.points.iter().zip(&back.points) {
            // 2⁻¹⁶ d of a place, 2⁻²⁰ d of an error, 0.1 nm of the file.
            assert_near(one.position_mm, other.position_mm, 2e-5 / counts_per_mm);
            for way in [0, 1] {
                assert_near(one.error_um[way], other.error_um[way], 1e-4 + 1e-3 / counts_per_mm);
            }
        }
    }
}
