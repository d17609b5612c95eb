//! The map of a real axis: what its own tick says, as the line tells it.

use leadscrew::axis::{Axis, Inputs};
use leadscrew::hal::Capture;
use leadscrew::protocol::service::Seen;
use leadscrew::supervisor::{Fault, State};
use leadscrew_app::modbus::View;

use crate::fake::{Unit, settings, view};

fn at(count: u32, enable: bool) -> Inputs<'static> {
    let capture = Capture {
        count,
        ..Capture::default()
    };
    Inputs::of(capture, enable)
}

fn seen(axis: &Axis<'_>) -> View {
    View {
        seen: Seen::of(axis),
        first_fault: axis.supervisor().first_fault().copied(),
        ..view()
    }
}

#[test]
fn an_axis_that_is_pushed_away_tells_where_and_why_it_stopped() {
    let mut axis = Axis::new(settings().validate().unwrap());
    let mut unit = Unit::default();
    for _ in 0..2_000 {
        axis.step(&at(100, true));
    }
    unit.panel.view = seen(&axis);
    let before = unit.read(4, 0, 82);
    assert_eq!(before[1], 0b1000_0110_0001, "{:b}", before[1]);
    assert_eq!(before[2..4], [State::Ready as u16, 0]);
    let tick = u32::from(before[6]) << 16 | u32::from(before[7]);
    assert_eq!(tick, axis.outputs().tick);
    // 1 000 d/mm; where it stood when it was switched on is its 0, half a count the sensing's.
    let position = i64::from(before[10]) << 16 | i64::from(before[11]);
    let expected = axis.outputs().reported.to_num::<f64>() * 1e3;
    assert!((position as f64 - expected).abs() <= 1.0, "{position}");

    while axis.outputs().fault.is_none() {
        axis.step(&at(3_100, true));
    }
    unit.panel.view = seen(&axis);
    let first = *axis.supervisor().first_fault().unwrap();
    assert_eq!(unit.read(4, 3, 1), [first.trip.fault as u16]);
    assert_eq!(unit.read(4, 48, 2), [0, first.tick as u16]);
    assert_eq!(unit.read(4, 50, 1), [first.state as u16]);
    let value = crate::fake::number(&unit.read(4, 54, 4));
    assert_eq!(value, first.trip.value.to_num::<f64>());
    assert!(unit.bits(100, 32)[first.trip.fault as usize]);
    assert!(Fault::from_number(first.trip.fault as u8).is_some());
    let place = unit.read(4, 62, 4);
    let place = place
        .iter()
        .fold(0, |sum, word| sum << 16 | i64::from(*word));
    let expected = first.context.position.to_num::<f64>() * 1e3;
    assert!((place as f64 - expected).abs() <= 1.0, "{place} {expected}");
}
