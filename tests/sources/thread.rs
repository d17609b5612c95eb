//! Threads on the simulated lathe, with the observer in the loop.

use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_host::threads::ThreadTable;

const BANDWIDTH_RAD_PER_S: f64 = 100.0;

fn assert_good(machine: &MachineParams, spindle_encoder: EncoderModel) -> ThreadTable {
    let table = ThreadTable::cut(machine, spindle_encoder, BANDWIDTH_RAD_PER_S, 2, 1).unwrap();
    println!("{table:#?}\nspread {}", table.phase_spread_deg());
    assert!(table.phase_spread_deg() <= 0.1);
    for row in &table.rows {
        assert!(row.pitch_error_d <= 2.0, "{row:?}");
    }
    table
}

#[test]
fn on_the_bare_machine_the_phase_is_the_same_at_every_speed_and_pass() {
    assert_good(&MachineParams::z_16k20f3().bare(), EncoderModel::ideal());
}

#[test]
fn on_the_full_machine_too() {
    assert_good(&MachineParams::z_16k20f3(), EncoderModel::real());
}
