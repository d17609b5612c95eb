//! A session as a tool has it, from factory settings on.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::settings::{Key, Number, Settings, Values};
use leadscrew_client::{Axis, Options};
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{Base, MoveAndBack};
use leadscrew_host::simulated_axis::{FlashImage, SimulatedAxis};

pub fn axis(flash: &FlashImage) -> Axis {
    let line = SimulatedAxis::new(Base::Full, 1000.0, 1, flash.clone()).unwrap();
    Axis::open(line, Options::default()).unwrap()
}

/// Names and values of all numbers.
struct Numbers(Vec<(String, f64)>);

impl Values for Numbers {
    fn number(&mut self, key: Key, _: &Number, value: f64) -> f64 {
        self.0.push((key.to_string(), value));
        value
    }

    fn word(&mut self, _: Key, _: &[&'static str], value: &'static str) -> &'static str {
        value
    }
}

/// A loop for the reference machine.
pub fn tuned() -> Vec<(String, f64)> {
    let machine = MachineParams::z_16k20f3();
    let scenario = MoveAndBack::standard(1000.0);
    let estimator = EstimatorConfig::by_name("exponential").unwrap().unwrap();
    let params = scenario.axis_params(&machine, estimator).unwrap();
    let mut settings = Settings {
        axis: params,
        ..Settings::new(estimator)
    };
    let mut numbers = Numbers(Vec::new());
    settings.visit(&mut numbers);
    numbers.0
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
