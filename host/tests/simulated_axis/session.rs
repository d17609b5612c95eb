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
    tool.save_parameters().unwrap();
    let status = tool.enable().unwrap();
    assert!(status.is_enabled);
    let status = tool.move_and_wait(20.0, 3000.0).unwrap();
    assert!((status.position_mm - 20.0).abs() < 0.02, "{status:?}");
    tool.disable().unwrap();
    drop(tool);

    let mut tool = axis(&flash);
    for (name, value) in tuned() {
        let found = tool.parameter(&name).unwrap().number();
        assert_eq!(found, Some(value), "{name}");
    }
}
