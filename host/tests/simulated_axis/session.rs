//! A session as a tool has it, from factory settings on.

use leadscrew_client::{Axis, Options};
use leadscrew_hal_mock::scenario::Base;
use leadscrew_host::simulated_axis::{FlashImage, SimulatedAxis};

pub use crate::tuned::tuned;

pub fn axis(flash: &FlashImage) -> Axis {
    let line = SimulatedAxis::new(Base::Full, 1000.0, 1, flash.clone()).unwrap();
    Axis::open(line, Options::default()).unwrap()
}

#[test]
fn an_axis_is_set_saved_and_moved_and_is_the_same_after_a_power_cycle() {
    let flash = FlashImage::blank();
    let mut tool = axis(&flash);
    tool.edit_parameters(|edit| {
        for (name, value) in tuned() {
            edit.set_parameter(&name, value)?;
        }
        Ok(())
    })
    .unwrap();
    assert!(tool.status().unwrap().is_unsaved);
    tool.save_parameters().unwrap();
    let status = tool.enable().unwrap();
    assert!(!status.is_unsaved);
    assert!(status.is_enabled);
    let status = tool.move_and_wait(20.0, 3000.0).unwrap();
    assert!((status.position_mm - 20.0).abs() < 0.02, "{status:?}");
    tool.disable().unwrap();
    drop(tool);

    let mut tool = axis(&flash);
    assert!(!tool.status().unwrap().is_unsaved);
    for (name, value) in tuned() {
        let found = tool.parameter(&name).unwrap().number();
        assert_eq!(found, Some(value), "{name}");
    }
}

#[test]
fn another_control_rate_is_in_force_after_a_restart() {
    let mut tool = axis(&FlashImage::blank());
    tool.edit_parameters(|edit| {
        for (name, value) in tuned() {
            edit.set_parameter(&name, value)?;
        }
        edit.set_parameter("tick_hz", 2000.0)
    })
    .unwrap();
    tool.save_parameters().unwrap();
    tool.restart().unwrap();
    let before = tool.status().unwrap().tick;
    let began = tool.connection().now();
    tool.wait(std::time::Duration::from_secs(1)).unwrap();
    let ticks = tool.status().unwrap().tick - before;
    let time = tool.connection().now() - began;
    let rate = f64::from(ticks) / time.as_secs_f64();
    assert!((rate - 2000.0).abs() < 20.0, "{rate}");
    tool.enable().unwrap();
    let status = tool.move_and_wait(5.0, 3000.0).unwrap();
    assert!((status.position_mm - 5.0).abs() < 0.02, "{status:?}");
}
