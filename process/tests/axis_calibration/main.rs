//! Calibration of axes after ISO 230-2, and the tables that come of it.

mod alias;
mod by_hand;
mod compensated;
mod files;
mod linuxcnc;
mod oracle;
mod uncertainty;

use leadscrew_process::axis_calibration::{Direction, Reading, Runs};

/// Readings of `of(target, direction, run)`, µm, at targets.
fn runs_of(targets: &[f64], runs: u32, mut of: impl FnMut(f64, Direction, u32) -> f64) -> Runs {
    let mut all = Runs::default();
    for run in 1..=runs {
        for direction in Direction::BOTH {
            for target in targets {
                all.readings.push(Reading {
                    target_mm: *target,
                    direction,
                    run,
                    deviation_um: of(*target, direction, run),
                    temperature_c: None,
                });
            }
        }
    }
    all
}

#[track_caller]
fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance,
        "{value} is not {expected} ± {tolerance}"
    );
}
