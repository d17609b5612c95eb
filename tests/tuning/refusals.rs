//! What autotune must not offer, planted: with the checks taken out it would be offered, and the machine would not stand.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::ObserverParams;
use leadscrew::params::AxisParams;
use leadscrew::tuning::DriveModel;
use leadscrew::tuning::autotune::{
    AutotuneError, EstimatorChoice, LEAST_GAIN_DB, LEAST_PHASE_DEG, autotune, margins, placed,
    prepared,
};
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_host::tracking::{Course, Rig, TrackingFigures, model_of};

const MOVE: Course = Course::Move {
    distance_mm: 30.0,
    feed_mm_per_min: 3000.0,
};
/// Octaves of edges a tick that are judged.
const OCTAVES: [i32; 3] = [1, 4, 7];

fn bare() -> MachineParams {
    MachineParams {
        encoder: EncoderModel::ideal(),
        ..MachineParams::z_16k20f3().bare()
    }
}

fn base() -> AxisParams {
    AxisParams::new(EstimatorConfig::by_name("observer").unwrap().unwrap())
}

fn observer() -> EstimatorChoice {
    EstimatorChoice::Observer(ObserverParams::default())
}

/// The loop of that radius and damping for `model`, with nothing checked but the ranges of its parameters.
fn unchecked(model: &DriveModel, radius: f64, damping: f64) -> AxisParams {
    let prepared = prepared(model, &base(), &observer()).unwrap();
    let params = placed(model, &prepared, radius, damping).unwrap();
    assert!(params.validate().is_ok());
    params
}

/// How it goes on the machine; none where the supervisor stops it, after which no move is taken.
fn run(machine: &MachineParams, params: &AxisParams) -> Option<TrackingFigures> {
    Rig::new(machine, params, None, 1).unwrap().run(&MOVE).ok()
}

/// Stopped by the supervisor, or swinging at rest.
fn does_not_stand(figures: Option<&TrackingFigures>) -> bool {
    figures.is_none_or(|figures| figures.rest_swing_d > 5.0)
}

#[test]
fn a_drive_too_late_for_any_loop_is_refused_by_its_margins() {
    let mut machine = bare();
    machine.drive.delay_s = 0.06;
    machine.drive.natural_period_s = 0.05;
    machine.drive.damping = 0.1;
    let model = model_of(&machine);
    let error = autotune(&model, &base(), &observer()).unwrap_err();
    assert!(matches!(error, AutotuneError::NoMargin(_)), "{error}");
    let message = error.to_string();
    assert!(
        message.contains("6 dB and 30°") && message.contains("shorten the delay"),
        "{message}"
    );
    // The radius that the same drive bears without the delay.
    let prompt = DriveModel {
        delay_s: 0.0,
        ..model
    };
    let (_, report) = autotune(&prompt, &base(), &observer()).unwrap();
    let params = unchecked(&model, report.bandwidth_rad_per_s, report.damping);
    let figures = run(&machine, &params);
    assert!(does_not_stand(figures.as_ref()), "{figures:?}");
    // The same loop on the drive without the delay is what stands.
    machine.drive.delay_s = 0.0;
    let figures = run(
        &machine,
        &unchecked(&prompt, report.bandwidth_rad_per_s, report.damping),
    );
    assert!(!does_not_stand(figures.as_ref()), "{figures:?}");
}

#[test]
fn a_loop_with_its_margins_that_its_drive_cannot_bear_is_refused_by_the_trial() {
    let good = bare();
    let (_, report) = autotune(&model_of(&good), &base(), &observer()).unwrap();
    // Guides that hold the axis with three quarters of full command: nothing linear shows them.
    let mut machine = good;
    machine.drive.friction_mm_per_min = 900.0;
    machine.drive.stiction_ratio = 8.0;
    let model = model_of(&machine);
    let params = unchecked(&model, report.bandwidth_rad_per_s, report.damping);
    let (_, worst) = margins(&model, &params, &OCTAVES).unwrap();
    assert!(
        worst.gain_db >= LEAST_GAIN_DB && worst.phase_deg >= LEAST_PHASE_DEG,
        "margins alone would let it pass: {worst:?}"
    );
    let figures = run(&machine, &params);
    assert!(does_not_stand(figures.as_ref()), "{figures:?}");

    let error = autotune(&model, &base(), &observer()).unwrap_err();
    let AutotuneError::Trial(trial) = error else {
        panic!("{error}")
    };
    assert!(trial.fault.is_some(), "{trial:?}");
    let message = error.to_string();
    assert!(
        message.contains("stops the axis for") && message.contains("ease the guides"),
        "{message}"
    );
}

#[test]
fn an_axis_that_its_drive_cannot_accelerate_is_refused_with_what_the_drive_gives() {
    let mut machine = bare();
    machine.drive.max_acceleration_m_s2 = 0.5;
    let model = model_of(&machine);
    let (_, report) = autotune(&model_of(&bare()), &base(), &observer()).unwrap();
    let params = unchecked(&model, report.bandwidth_rad_per_s, report.damping);
    let (_, worst) = margins(&model, &params, &OCTAVES).unwrap();
    assert!(
        worst.gain_db >= LEAST_GAIN_DB && worst.phase_deg >= LEAST_PHASE_DEG,
        "margins alone would let it pass: {worst:?}"
    );
    let figures = run(&machine, &params).unwrap();
    assert!(figures.following.peak() > 200.0, "{figures:?}");

    let error = autotune(&model, &base(), &observer()).unwrap_err();
    assert!(matches!(error, AutotuneError::Behind { .. }), "{error}");
    let message = error.to_string();
    assert!(
        message.contains("0.50 m/s²") && message.contains("less feed or acceleration"),
        "{message}"
    );
}
