//! What a link does when something is wrong around it.

use std::time::Duration;

use leadscrew::protocol::refusal::Refusal;
use leadscrew::supervisor::Fault;
use leadscrew_client::{Axis, Error, Options};
use leadscrew_hal_mock::scenario::Base;
use leadscrew_host::simulated_axis::{FlashImage, SimulatedAxis};

use crate::session::{axis, tuned};

fn set_up(tool: &mut Axis) {
    tool.edit_parameters(|edit| {
        for (name, value) in tuned() {
            edit.set_parameter(&name, value)?;
        }
        Ok(())
    })
    .unwrap();
}

#[test]
fn an_order_that_the_axis_refuses_in_its_tick_is_answered_by_that_refusal() {
    let mut tool = axis(&FlashImage::blank());
    set_up(&mut tool);
    // It is the axis, not the service, that knows that it is not ready.
    let error = tool.home().unwrap_err();
    assert_eq!(error.refusal(), Some(Refusal::NotReady), "{error}");
}

#[test]
fn damaged_parameters_keep_the_axis_off_until_they_are_saved_anew() {
    let flash = FlashImage::blank();
    let mut tool = axis(&flash);
    set_up(&mut tool);
    tool.save_parameters().unwrap();
    drop(tool);
    let mut cells = flash.cells();
    let name = b"natural_period_s";
    let place = cells.windows(name.len()).position(|place| place == name);
    // Behind the name comes its value.
    cells[place.unwrap() + name.len() + 4] ^= 0x55;
    let damaged = FlashImage::of(cells);
    let line = SimulatedAxis::new(Base::Full, 1000.0, 1, damaged).unwrap();
    assert!(!line.loaded().report.is_clean());
    let mut tool = Axis::open(line, Options::default()).unwrap();
    let error = tool.enable().unwrap_err();
    let store = Fault::ALL
        .iter()
        .find(|fault| fault.name().contains("Store"));
    assert!(
        matches!(error, Error::Faulted(number) if number == *store.unwrap() as u8),
        "{error}"
    );
    tool.disable().unwrap();
    set_up(&mut tool);
    tool.save_parameters().unwrap();
    tool.wait(Duration::from_millis(20)).unwrap();
    tool.clear_fault().unwrap();
    assert!(tool.enable().unwrap().is_enabled);
}

#[test]
fn nothing_is_saved_while_the_axis_is_on() {
    let mut tool = axis(&FlashImage::blank());
    set_up(&mut tool);
    tool.enable().unwrap();
    let error = tool.save_parameters().unwrap_err();
    assert_eq!(error.refusal(), Some(Refusal::AxisOn), "{error}");
}

#[test]
fn a_flash_that_holds_no_store_is_made_one() {
    // Neither blank nor a store: sector by sector something else.
    let cells = (0..leadscrew_host::simulated_axis::CAPACITY)
        .map(|at| (at as u32).wrapping_mul(2_654_435_761).to_be_bytes()[0])
        .collect();
    let mut tool = axis(&FlashImage::of(cells));
    set_up(&mut tool);
    // What cannot be read was made blank: it was no store.
    tool.save_parameters().unwrap();
    assert!(tool.enable().unwrap().is_enabled);
}
