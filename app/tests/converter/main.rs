//! The converter's words against a model of it made from the data sheet.

mod chip;
mod upkeep;

use chip::Chip;
use leadscrew::units::Command;
use leadscrew_app::converter::{Converter, PUT_OUT_ZERO, Trouble, ZERO, of_command, to_command};

fn started() -> (Chip, Converter) {
    let mut chip = Chip::default();
    let converter = Converter::start(&mut chip, true).expect("well");
    (chip, converter)
}

fn command(value: f64) -> Command {
    Command::saturating_from_num(value)
}

#[test]
fn it_starts_in_its_range_at_zero_and_puts_out_nothing_else() {
    let (chip, _) = started();
    assert_eq!((chip.output, chip.volts()), (ZERO, 0.0));
    assert_eq!(
        chip.control, 0b010_0110_1000,
        "±10 V, 0 V at power-up and clear, internal reference"
    );
    assert!(chip.seen_out.iter().all(|code| *code == ZERO));
    // With /LDAC low the patterns that try the wires would be voltages: the board keeps it high.
    let mut let_through = Chip::default();
    let_through.is_let_through = true;
    assert!(Converter::start(&mut let_through, true).is_ok());
    assert!(let_through.seen_out.iter().any(|code| *code != ZERO));
    assert!(Converter::start(&mut Chip::default(), false).is_ok());
}

#[test]
fn a_command_is_put_out_and_comes_back() {
    let (mut chip, mut converter) = started();
    for value in [0.0, 0.5, -0.5, 1e-4, -1.0, 0.999, 1.0, 1.9, -2.0] {
        let put = converter.put(&mut chip, command(value), false);
        assert_eq!(put.trouble, None);
        assert_eq!(put.readback, to_command(of_command(command(value))));
        assert!(
            (chip.volts() - 10.0 * value.clamp(-1.0, 1.0)).abs() <= 3.1e-4,
            "{value}"
        );
    }
    chip.exchange_word(PUT_OUT_ZERO);
    assert_eq!(chip.volts(), 0.0);
}

#[test]
fn a_tick_is_three_words() {
    let (mut chip, mut converter) = started();
    let before = chip.words;
    converter.put(&mut chip, command(0.1), false);
    assert_eq!(chip.words - before, 3);
}

/// Troubles of the ticks after `harm` was done to a converter that puts out `value`.
fn after(value: f64, harm: impl Fn(&mut Chip)) -> Vec<Option<Trouble>> {
    let (mut chip, mut converter) = started();
    converter.put(&mut chip, command(value), false);
    harm(&mut chip);
    let troubles = (0..3).map(|_| {
        let put = converter.put(&mut chip, command(value), false);
        let off = (put.readback - command(value)).abs();
        assert_eq!(
            put.trouble.is_some(),
            off >= 1,
            "a mismatch whatever the tolerance"
        );
        put.trouble
    });
    troubles.collect()
}

#[test]
fn what_is_wrong_is_told_within_two_ticks() {
    for value in [0.0, 0.7, -0.7] {
        let silent = after(value, |chip| chip.is_dead = true);
        assert_eq!(silent, [Some(Trouble::Silent); 3]);
        let stuck = after(value, |chip| chip.stuck = Some(0xff_ffff));
        assert_eq!(stuck, [Some(Trouble::Silent); 3]);
        let stuck = after(value, |chip| chip.stuck = Some(0));
        assert_eq!(stuck, [Some(Trouble::Silent); 3]);
        let shorted = after(value, |chip| chip.is_shorted = true);
        assert_eq!(shorted[1..], [Some(Trouble::ShortCircuit); 2]);
        let fallen = after(value, Chip::brown_out);
        assert_eq!(fallen[1..], [Some(Trouble::BrownOut); 2]);
        let other_range = after(value, |chip| chip.control ^= 0b011);
        assert!(matches!(other_range[1], Some(Trouble::Settings { .. })));
    }
}

#[test]
fn a_bit_that_is_stuck_in_the_output_is_a_readback_that_differs() {
    let (mut chip, mut converter) = started();
    chip.lost_bits = 0x4000;
    let put = converter.put(&mut chip, command(0.75), false);
    assert_eq!((put.trouble, put.readback), (None, command(0.25)));
}

#[test]
fn the_alert_line_is_a_trouble() {
    let (mut chip, mut converter) = started();
    let put = converter.put(&mut chip, command(0.3), true);
    assert_eq!(put.trouble, Some(Trouble::Alert));
    assert_eq!(put.readback, command(-1.0));
    assert_eq!(converter.put(&mut chip, command(0.3), false).trouble, None);
}

#[test]
fn a_converter_that_is_not_well_does_not_start() {
    let start = |harm: fn(&mut Chip)| {
        let mut chip = Chip::default();
        harm(&mut chip);
        Converter::start(&mut chip, true).map(|_| ())
    };
    assert_eq!(start(|chip| chip.is_dead = true), Err(Trouble::Silent));
    assert_eq!(start(|chip| chip.stuck = Some(0)), Err(Trouble::Silent));
    let garbled = start(|chip| chip.lost_bits = 0x0004);
    assert_eq!(
        garbled,
        Err(Trouble::Garbled {
            sent: 0x5555,
            seen: 0x5551
        })
    );
    assert_eq!(
        start(|chip| chip.is_shorted = true),
        Err(Trouble::ShortCircuit)
    );
    let deaf = start(|chip| chip.is_control_locked = true);
    assert!(matches!(
        deaf,
        Err(Trouble::Settings { .. } | Trouble::BrownOut)
    ));
}

#[test]
fn after_one_lost_tick_of_the_bus_it_goes_on() {
    let (mut chip, mut converter) = started();
    chip.is_dead = true;
    assert_eq!(
        converter.put(&mut chip, command(0.2), false).trouble,
        Some(Trouble::Silent)
    );
    chip.is_dead = false;
    assert_eq!(converter.put(&mut chip, command(0.2), false).trouble, None);
    assert_eq!(converter.put(&mut chip, command(0.2), false).trouble, None);
}
