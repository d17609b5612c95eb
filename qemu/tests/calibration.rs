//! A map learned on the target and on the host is the same, bit for bit.

use std::fmt::Write;

use leadscrew_hal_mock::disc::DiscParams;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_host::calibration::{Procedure, learn_simulated};
use leadscrew_qemu::{LARGEST_SHIFT, Run, build};

/// As `boards/mps2-an386/src/bin/calibrate.rs` has them.
const EDGES: f64 = 2000.0;
const SEED: u64 = 7;
const REVOLUTIONS: u32 = 12;

/// The image of the host as the firmware logs it: lines of 32 bytes, the last one filled up with zeros.
fn host_lines() -> Vec<String> {
    let model = EncoderModel {
        disc: DiscParams {
            edges_per_revolution: EDGES,
            ..DiscParams::default()
        },
        ..EncoderModel::real()
    };
    let procedure = Procedure {
        revolutions: REVOLUTIONS,
        ..Procedure::default()
    };
    let image = learn_simulated(&model, SEED, &procedure).unwrap();
    let line = |(number, bytes): (usize, &[u8])| {
        let mut text = format!("map {} ", 32 * number);
        for place in 0..32 {
            let byte = bytes.get(place).copied().unwrap_or(0);
            write!(text, "{byte:02x}").unwrap();
        }
        text
    };
    let mut lines: Vec<_> = image.chunks(32).enumerate().map(line).collect();
    lines.push(format!("map of {} bytes", image.len()));
    lines
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_map_learned_on_the_target_is_that_of_the_host() {
    let output = Run::new(build("calibrate", "firmware").unwrap())
        .shift(LARGEST_SHIFT)
        .run()
        .unwrap();
    assert_eq!(output.exit_code, 0, "{output}");
    let messages = output.log_lines.iter().map(|line| line.message.as_str());
    let logged: Vec<_> = messages
        .filter(|message| message.starts_with("map "))
        .collect();
    assert_eq!(logged, host_lines());
}
