//! Uncertainties worked out by hand.

use leadscrew_process::axis_calibration::{Calibration, Expansion, Sources};

use crate::{assert_near, runs_of};

#[test]
fn each_source_alone_and_all_together() {
    // 1 m, 8 runs.
    let runs = runs_of(&[0.0, 250.0, 500.0, 750.0, 1000.0], 8, |_, _, _| 0.0);
    let found = Calibration::of(&runs, &Expansion::default(), true).unwrap();
    let of = |sources: Sources| sources.of(&found, 11.5, 3.0).unwrap();
    let device = of(Sources {
        device_um_per_m: 0.7,
        ..Sources::default()
    });
    assert_near(device.device_um, 0.7, 1e-12);
    assert_near(device.systematic_um, 0.7, 1e-12);
    assert_near(device.repeatability_um, 0.0, 0.0);
    let aside = of(Sources {
        misalignment_mm: 1.0,
        ..Sources::default()
    });
    // 1 mm aside over 1 m: 0.5 µm too little at most.
    assert_near(aside.alignment_um, 0.5 / 3_f64.sqrt(), 1e-12);
    let thermometer = of(Sources {
        thermometer_range_k: 2.0,
        ..Sources::default()
    });
    assert_near(thermometer.thermometer_um, 23.0 / 3_f64.sqrt(), 1e-12);
    // The standard's 0.6 is 1/√3, rounded.
    assert_near(thermometer.thermometer_um, 0.6 * 23.0, 0.04 * 23.0 * 0.6);
    let expansion = of(Sources {
        expansion_range_um_per_m_k: 2.0,
        ..Sources::default()
    });
    assert_near(expansion.expansion_um, 6.0 / 3_f64.sqrt(), 1e-12);
    let drift = of(Sources {
        drift_um: 3_f64.sqrt(),
        ..Sources::default()
    });
    assert_near(drift.drift_um, 1.0, 1e-12);
    assert_near(drift.reversal_um, 0.5, 1e-12);
    assert_near(drift.repeatability_um, 2.0, 1e-12);
    assert_near(drift.mean_range_um, (1.0_f64 / 8.0).sqrt(), 1e-12);
    assert_near(drift.systematic_um, 0.5, 1e-12);
    assert_near(drift.accuracy_um, (0.25_f64 + 4.0).sqrt(), 1e-12);
    let all = of(Sources {
        device_um_per_m: 0.7,
        misalignment_mm: 1.0,
        thermometer_range_k: 2.0,
        expansion_range_um_per_m_k: 2.0,
        drift_um: 3_f64.sqrt(),
    });
    let squares = 0.49 + 0.25 / 3.0 + 23.0 * 23.0 / 3.0 + 12.0;
    assert_near(all.mean_range_um, (squares + 0.125_f64).sqrt(), 1e-9);
    assert_near(all.accuracy_um, (squares + 0.25 + 4.0_f64).sqrt(), 1e-9);
    let wrong = Sources {
        drift_um: -1.0,
        ..Sources::default()
    };
    assert_eq!(wrong.of(&found, 11.5, 0.0).unwrap_err().name, "drift_um");
}
