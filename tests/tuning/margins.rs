//! Predicted margins against the simulated machine, its gain raised until the loop oscillates.

use leadscrew::controller::params::FilterParams;
use leadscrew::params::AxisParams;
use leadscrew::tuning::margins::Loop;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_host::tracking::{Rig, model_of, tuned_on};

/// Steady feed of the trial: 40 edges a tick, the octave of 32.
const FEED: f64 = 2400.0;
const OCTAVE: i32 = 5;

fn bare(delay_s: f64) -> MachineParams {
    let mut machine = MachineParams::z_16k20f3().bare();
    machine.encoder = EncoderModel::ideal();
    machine.drive.delay_s = delay_s;
    machine
}

/// True if the loop of `params` oscillates on `machine` with its gain times `factor`.
fn oscillates(machine: &MachineParams, params: &AxisParams, factor: f64) -> bool {
    let mut actual = *machine;
    actual.drive.full_command_feed_mm_per_min *= factor;
    let mut rig = Rig::new(&actual, params, None, 1).unwrap();
    // A stable loop comes to the steady feed; an unstable one swings by as much as the drive's acceleration lets it.
    rig.cruise(160.0, FEED).unwrap().rms() > 1.0
}

/// Gain at which oscillation begins, dB.
fn found(machine: &MachineParams, params: &AxisParams) -> f64 {
    let (mut low, mut high) = (1.0_f64, 8.0_f64);
    assert!(!oscillates(machine, params, low) && oscillates(machine, params, high));
    for _ in 0..7 {
        let middle = (low * high).sqrt();
        if oscillates(machine, params, middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    20.0 * (low * high).sqrt().log10()
}

#[test]
fn the_predicted_gain_margin_is_that_of_the_simulated_loop_to_a_decibel() {
    let low_pass = FilterParams {
        low_pass_hz: 120.0,
        ..FilterParams::default()
    };
    for (delay_s, filter) in [(0.0, None), (0.002, None), (0.0, Some(low_pass))] {
        let machine = bare(delay_s);
        let (mut params, _) = tuned_on(&machine).unwrap();
        if let Some(filter) = filter {
            params.filter = filter;
        }
        let predicted = Loop::new(&params, OCTAVE)
            .unwrap()
            .margins(&model_of(&machine))
            .unwrap();
        let found = found(&machine, &params);
        assert!(
            (found - predicted.gain_db).abs() < 1.0,
            "delay {delay_s}: {found} dB, predicted {predicted:?}"
        );
    }
}

#[test]
fn a_filter_and_a_delay_cost_margin() {
    let machine = bare(0.0);
    let (params, _) = tuned_on(&machine).unwrap();
    let margins = |params: &AxisParams, delay_s: f64| {
        let mut model = model_of(&machine);
        model.delay_s = delay_s;
        Loop::new(params, OCTAVE).unwrap().margins(&model).unwrap()
    };
    let plain = margins(&params, 0.0);
    let late = margins(&params, 0.002);
    assert!(late.gain_db < plain.gain_db - 1.0 && late.phase_deg < plain.phase_deg - 5.0);
    let mut filtered = params;
    filtered.filter.low_pass_hz = 80.0;
    let smoothed = margins(&filtered, 0.0);
    assert!(smoothed.phase_deg < plain.phase_deg - 5.0);
}
