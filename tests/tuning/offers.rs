//! What autotune offers keeps its margins, and what it cannot offer it refuses.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::ObserverParams;
use leadscrew::params::{AxisParams, ParamError};
use leadscrew::tuning::DriveModel;
use leadscrew::tuning::autotune::{
    AutotuneError, EstimatorChoice, LEAST_GAIN_DB, LEAST_PHASE_DEG, autotune,
};
use leadscrew::tuning::margins::Loop;

fn base() -> AxisParams {
    AxisParams::new(EstimatorConfig::by_name("observer").unwrap().unwrap())
}

fn observer() -> EstimatorChoice {
    EstimatorChoice::Observer(ObserverParams::default())
}

#[test]
fn every_corner_of_every_drive_keeps_six_decibels_and_thirty_degrees() {
    for (period_s, damping, delay_s) in [
        (0.09, 0.5, 0.002),
        (0.09, 0.5, 0.0),
        (0.05, 0.7, 0.001),
        (0.15, 0.4, 0.003),
    ] {
        let model = DriveModel {
            delay_s,
            ..DriveModel::second_order(period_s, damping)
        };
        let (params, report) = autotune(&model, &base(), &observer()).unwrap();
        // Judged anew, at densities and on drives between those that the search looks at too.
        for octave in 1..=7 {
            let judged = Loop::new(&params, octave).unwrap();
            for gain in [0.8, 0.9, 1.0, 1.1, 1.2] {
                for period in [0.8, 0.9, 1.0, 1.1, 1.2] {
                    let drive = DriveModel {
                        full_command_feed_mm_per_min: model.full_command_feed_mm_per_min * gain,
                        natural_period_s: model.natural_period_s * period,
                        ..model
                    };
                    let margins = judged.margins(&drive).unwrap();
                    let tolerance = 0.05;
                    assert!(
                        margins.gain_db > LEAST_GAIN_DB - tolerance
                            && margins.reserve_db > LEAST_GAIN_DB - tolerance
                            && margins.phase_deg > LEAST_PHASE_DEG - tolerance,
                        "{period_s} s, {gain}, {period}, octave {octave}: {margins:?} {report:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn more_delay_makes_a_slower_loop() {
    // At high frequency the loop is 4κr/s.
    let loop_gain = |delay_s| {
        let model = DriveModel {
            delay_s,
            ..DriveModel::second_order(0.09, 0.5)
        };
        let (_, report) = autotune(&model, &base(), &observer()).unwrap();
        report.damping * report.bandwidth_rad_per_s
    };
    let [none, two, four] = [0.0, 0.002, 0.004].map(loop_gain);
    assert!(none > 1.1 * two && two > 1.1 * four, "{none} {two} {four}");
}

#[test]
fn a_feed_above_95_percent_of_full_command_is_refused_with_the_figure() {
    let model = DriveModel {
        full_command_feed_mm_per_min: 9400.0,
        ..DriveModel::default()
    };
    let error = autotune(&model, &base(), &observer()).unwrap_err();
    let AutotuneError::Param(ParamError::FeedTooHigh {
        full_command_feed_mm_per_min,
        ..
    }) = error
    else {
        panic!("{error}")
    };
    assert_eq!(full_command_feed_mm_per_min, 9400.0);
}

#[test]
fn a_loop_that_cannot_keep_its_margins_is_not_offered() {
    let model = DriveModel {
        delay_s: 0.06,
        ..DriveModel::second_order(0.05, 0.1)
    };
    let error = autotune(&model, &base(), &observer()).unwrap_err();
    assert!(matches!(error, AutotuneError::NoMargin(_)), "{error}");
}
