//! The reference machine under the simulated laser: readings as a file, its calibration, the table on the axis, readings again.

use leadscrew::compensation::{CompensationParams, ScrewTable, Stretch};
use leadscrew::estimator::EstimatorConfig;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;
use leadscrew_host::screw::ScrewCase;
use leadscrew_process::axis_calibration::{Alias, Calibration, ErrorTable, Expansion, Runs};

/// The bare drive, and all that lies between encoder and carriage, with 3 µm of play.
fn case() -> ScrewCase<'static> {
    let full = MachineParams::z_16k20f3();
    let mut machine = full.bare();
    machine.encoder = EncoderModel::real();
    machine.carriage = full.carriage;
    machine.carriage.backlash_mm = 0.003;
    let scenario = MoveAndBack::standard(1000.0);
    let estimator = EstimatorConfig::by_name("simple").unwrap().unwrap();
    let axis = scenario.axis_params(&machine, estimator).unwrap();
    ScrewCase {
        machine,
        axis,
        map: None,
        seed: 1,
        runs: 1,
        travel_mm: 60.0,
        points: 49,
        settle_s: 0.6,
    }
}

/// What the laser reads at targets, d, as the file that people bring.
fn read(case: &ScrewCase<'_>, table: Option<ScrewTable<'_>>, targets: &[f64]) -> Calibration {
    let compensation = CompensationParams {
        screw_table: if table.is_some() { 1.0 } else { 0.0 },
        ..CompensationParams::default()
    };
    let runs = case.runs(compensation, table, targets, 5).unwrap();
    let runs = Runs::read(&runs.to_csv()).unwrap();
    Calibration::of(&runs, &Expansion::default(), true).unwrap()
}

#[test]
fn the_table_of_a_calibration_leaves_what_the_counts_leave() {
    let case = case();
    // Eight targets a turn of 10 mm and a bit: not multiples of the pitch.
    let at = |count: u32, phase: f64| -> Vec<f64> {
        (0..count)
            .map(|at| 1000.0 * (phase + 1.23 * f64::from(at)))
            .collect()
    };
    let targets = at(45, 2.1);
    let before = read(&case, None, &targets);
    let places: Vec<f64> = targets.iter().map(|target| target / 1000.0).collect();
    assert_eq!(Alias::of(&places, 10.0), None);
    let points = ErrorTable::of(&before).to_screw(1000.0).unwrap();
    let mut memory = vec![Stretch::EMPTY; points.len()];
    let table = ScrewTable::build(&points, &mut memory).unwrap();
    // Between the points of the table.
    let after = read(&case, Some(table), &at(20, 2.7));
    println!("before {:?}\nafter {:?}", before.axis, after.axis);
    assert!(before.axis.systematic_um > 4.0 && before.axis.mean_reversal_um < -2.0);
    // A count is 1 µm, and the servo may stand anywhere within it at either reading.
    assert!(after.axis.systematic_um < 2.0, "{:?}", after.axis);
    assert!(after.axis.mean_reversal_um.abs() < 0.5, "{:?}", after.axis);
}
