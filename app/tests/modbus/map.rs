//! Every register and every bit, against an axis whose values are all different.

use leadscrew::protocol::service::Seen;
use leadscrew::supervisor::{Context, Fault, FaultSet, FirstFault, State, Trip};
use leadscrew::units::{AxisScale, Position, Velocity};
use leadscrew_app::modbus::bits::{BITS, FAULTS, NUMBERS, STATUS, WARNINGS};
use leadscrew_app::modbus::registers::REGISTERS;
use leadscrew_app::modbus::{ProbeLatch, View};
use leadscrew_app::tick::Counts;

use crate::fake::{Fake, Unit, asking, view};

/// 400 d/mm at 2 kHz: a count is 2.5 µm, a d/tick 300 mm/min.
fn busy() -> View {
    let first_fault = FirstFault {
        trip: Trip {
            fault: Fault::Overspeed,
            value: Position::from_num(123.5),
            limit: Position::from_num(-120.25),
        },
        tick: 0x0102_0304,
        state: State::Moving,
        context: Context {
            position: Position::from_num(1_400),
            velocity: Velocity::from_num(250),
            setpoint_position: Position::from_num(1_800),
            setpoint_velocity: Velocity::ZERO,
            following_error: (-2_i16).into(),
            command: leadscrew::units::Command::from_num(-0.75),
        },
        later: FaultSet::default().with(Fault::SoftLimit),
    };
    View {
        seen: Seen {
            count: -7,
            tick: 0xfedc_ba98,
            state: State::Fault,
            enabled: true,
            moving: true,
            fault: Some(Fault::Overspeed),
            warnings: 0x8000_0012,
            commanded: Position::from_num(-40_000_000_000_i64),
            reported: Position::from_num(40_000_001),
            velocity: Velocity::from_num(-500),
            following_error: 3 << 16,
            origin: Some(Position::from_num(1_000)),
            travel: None,
            is_planned: true,
            dropped_plans: 0,
        },
        scale: AxisScale::new(400.0, 2_000.0).unwrap(),
        percent: 120,
        is_held: true,
        is_leased: true,
        counts: Counts {
            late: 70_001,
            overlong: 70_002,
            lost_records: 70_003,
            ..Counts::default()
        },
        first_fault: Some(first_fault),
        probe: Some(ProbeLatch {
            count: 65_535,
            position_nm: -5_000_000_001,
        }),
        capabilities: 0x0001_0007,
    }
}

/// A value as its registers tell it.
#[track_caller]
fn value(unit: &mut Unit, name: &str) -> f64 {
    let register = REGISTERS.iter().find(|register| register.name == name);
    let register = register.unwrap();
    let words = unit.read(4, register.address, register.count);
    let bits = words
        .iter()
        .fold(0, |sum, word| sum << 16 | u64::from(*word));
    match register.kind {
        "u16" | "u32" => bits as f64,
        "i16" => f64::from(bits as u16 as i16),
        "i32" => f64::from(bits as u32 as i32),
        "i64" => bits as i64 as f64,
        "f32" => f64::from(f32::from_bits(bits as u32)),
        "f64" => f64::from_bits(bits),
        kind => panic!("{kind}"),
    }
}

#[test]
fn the_table_has_no_gap_and_no_name_twice() {
    let mut next = 0;
    let mut names = Vec::new();
    for register in REGISTERS {
        assert_eq!(register.address, next, "{}", register.name);
        // Values of more than a register begin at an even one: some masters ask for that.
        assert!(register.count == 1 || next % 2 == 0, "{}", register.name);
        next += register.count;
        names.push(register.name);
    }
    assert!(next <= 125, "one request reads it all");
    let bits = BITS.iter().map(|bit| bit.number);
    assert!(bits.eq(0..BITS.len() as u16) && BITS.len() <= usize::from(STATUS));
    names.extend(BITS.iter().map(|bit| bit.name));
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
}

#[test]
fn every_register_says_what_its_name_does() {
    let mut unit = Unit::of(Fake {
        view: busy(),
        ..Fake::default()
    });
    unit.write(5000, &[1]);
    let position = 40_000_001.0 / 400.0;
    let setpoint = -40_000_001_000.0 / 400.0;
    let expected = [
        ("map_version", 1.0),
        ("status", f64::from(0b0101_1011_1111)),
        ("state", 5.0),
        ("fault", 15.0),
        ("warnings", f64::from(0x8000_0012_u32)),
        ("tick", f64::from(0xfedc_ba98_u32)),
        ("position_nm", position * 1e6),
        ("setpoint_nm", setpoint * 1e6),
        ("velocity_um_per_min", -150_000_000.0),
        ("following_error_nm", 7_500.0),
        ("position_mm", f64::from(position as f32)),
        ("setpoint_mm", f64::from(setpoint as f32)),
        ("velocity_mm_per_min", -150_000.0),
        ("following_error_mm", f64::from(0.0075_f32)),
        ("position_um", (position * 1e3_f64).round()),
        ("velocity_short", -32_768.0),
        ("following_error_short", 8.0),
        ("override_percent", 120.0),
        ("probe_count", 65_535.0),
        ("probe_nm", -5_000_000_001.0),
        ("probe_mm", -5_000.0),
        ("tick_hz", 2_000.0),
        ("late_ticks", 70_001.0),
        ("overlong_ticks", 70_002.0),
        ("lost_records", 70_003.0),
        ("fault_tick", f64::from(0x0102_0304)),
        ("fault_state", 3.0),
        ("reserved", 0.0),
        ("fault_later", f64::from(1 << 14)),
        ("fault_value", 123.5),
        ("fault_limit", -120.25),
        ("fault_position_nm", 1e6),
        ("fault_setpoint_nm", 2e6),
        ("fault_velocity_um_per_min", 75_000_000.0),
        ("fault_following_error_nm", -5_000.0),
        ("fault_command", -0.75),
        ("capabilities", f64::from(0x0001_0007)),
        // Of the names in docs/modbus.md; of which there are as many.
        ("parameter_list", f64::from(crate::page::list_checksum())),
        ("parameter_count", crate::page::names().len() as f64),
        ("last_refusal", 24.0),
    ];
    for (name, expected) in expected {
        assert_eq!(value(&mut unit, name), expected, "{name}");
    }
    let told: Vec<_> = REGISTERS.iter().map(|register| register.name).collect();
    assert_eq!(told[..told.len() - 2], expected.map(|(name, _)| name));
    // This is the request after one write and one read for each name.
    assert_eq!(value(&mut unit, "line_frames"), 2.0 + expected.len() as f64);
    assert_eq!(value(&mut unit, "line_dropped"), 0.0);
    unit.hear(&[1, 2, 3]);
    assert_eq!(value(&mut unit, "line_dropped"), 3.0);
}

#[test]
fn an_axis_without_fault_and_probe_says_zeros_there() {
    let mut unit = Unit::default();
    for register in REGISTERS {
        let name = register.name;
        if name.starts_with("fault") || name.starts_with("probe") {
            assert_eq!(value(&mut unit, name), 0.0, "{name}");
        }
    }
    assert_eq!(value(&mut unit, "status"), f64::from(0b1010_0000_0000));
}

#[test]
fn positions_beyond_their_type_stay_at_its_end() {
    let mut panel = Fake::default();
    panel.view.seen.reported = Position::MIN;
    panel.view.seen.following_error = i32::MIN;
    panel.view.scale = AxisScale::new(0.001, 1_000.0).unwrap();
    let mut unit = Unit::of(panel);
    assert_eq!(value(&mut unit, "position_nm"), i64::MIN as f64);
    assert_eq!(value(&mut unit, "position_um"), f64::from(i32::MIN));
    assert_eq!(value(&mut unit, "following_error_nm"), f64::from(i32::MIN));
    assert_eq!(value(&mut unit, "following_error_short"), -32_768.0);
}

#[test]
fn all_reads_of_a_register_agree() {
    let mut unit = Unit::of(Fake {
        view: busy(),
        ..Fake::default()
    });
    let last = REGISTERS.last().unwrap();
    // Without the counts of the line, which count.
    let end = last.address - 2;
    let all = unit.read(4, 0, end);
    assert_eq!(unit.read(3, 0, end), all);
    for address in 0..end {
        let one = unit.read(4, address, 1);
        assert_eq!(one, all[usize::from(address)..][..1], "{address}");
    }
}

#[test]
fn registers_that_are_not_there_are_refused() {
    let mut unit = Unit::default();
    let last = REGISTERS.last().unwrap();
    let end = last.address + last.count;
    let count = crate::page::names().len() as u16;
    for address in [
        end,
        999,
        1000 + 4 * count,
        4000 + 4 * count,
        4999,
        5001,
        u16::MAX,
    ] {
        for function in [3, 4] {
            let reply = unit.ask(&asking(function, address, 1));
            assert_eq!(reply, [function | 0x80, 2], "{address}");
        }
    }
    for (address, count) in [(0, end + 1), (end - 1, 2), (5000, 2), (u16::MAX, 2)] {
        assert_eq!(unit.ask(&asking(4, address, count)), [0x84, 2]);
    }
    // There are no coils.
    for request in [
        asking(1, 0, 1),
        asking(5, 0, 0xff00),
        vec![15, 0, 0, 0, 1, 1, 1],
    ] {
        assert_eq!(unit.ask(&request), [request[0] | 0x80, 2]);
    }
}

#[test]
fn every_bit_says_what_its_name_does() {
    let mut unit = Unit::of(Fake {
        view: busy(),
        ..Fake::default()
    });
    let mut flip = |name: &str, change: fn(&mut View), expected: bool| {
        let bit = BITS.iter().find(|bit| bit.name == name).unwrap();
        unit.panel.view = if expected { view() } else { busy() };
        if name == "settable" || name == "clean" {
            unit.panel.view = if expected { busy() } else { view() };
        }
        assert_eq!(unit.bits(bit.number, 1), [!expected], "{name}");
        change(&mut unit.panel.view);
        assert_eq!(unit.bits(bit.number, 1), [expected], "{name}");
        let status = unit.read(4, 1, 1)[0];
        assert_eq!(status & 1 << bit.number != 0, expected, "{name}");
    };
    flip("enabled", |view| view.seen.enabled = true, true);
    flip("moving", |view| view.seen.moving = true, true);
    flip(
        "homed",
        |view| view.seen.origin = Some(Position::ZERO),
        true,
    );
    flip("held", |view| view.is_held = true, true);
    flip("leased", |view| view.is_leased = true, true);
    flip("planned", |view| view.seen.is_planned = true, true);
    flip("ready", |view| view.seen.state = State::Ready, true);
    flip("ready", |view| view.seen.state = State::Moving, true);
    flip(
        "faulted",
        |view| view.seen.fault = Some(Fault::SoftLimit),
        true,
    );
    flip("warned", |view| view.seen.warnings = 1 << 31, true);
    flip("settable", |view| view.seen.enabled = false, true);
    flip("settable", |view| view.seen.state = State::Enabling, false);
    flip("settable", |view| view.seen.enabled = true, false);
    let probe = |view: &mut View| view.probe = busy().probe;
    flip("probed", probe, true);
    flip("clean", |view| view.counts = Counts::default(), true);
    flip("clean", |view| view.counts.overlong = 1, false);
}

#[test]
fn faults_and_warnings_have_an_input_each() {
    let mut unit = Unit::of(Fake {
        view: busy(),
        ..Fake::default()
    });
    let only = |on: &[u16]| (0..NUMBERS).map(|at| on.contains(&at)).collect::<Vec<_>>();
    assert_eq!(unit.bits(FAULTS, NUMBERS), only(&[15]));
    assert_eq!(unit.bits(WARNINGS, NUMBERS), only(&[1, 4, 31]));
    unit.panel.view = view();
    assert_eq!(unit.bits(FAULTS, NUMBERS), only(&[]));
    for (address, count) in [(0, 17), (16, 1), (99, 1), (131, 2), (232, 1), (u16::MAX, 2)] {
        assert_eq!(unit.ask(&asking(2, address, count)), [0x82, 2]);
    }
}
