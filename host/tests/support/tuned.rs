//! Parameters of a loop for the reference machine, as a tool sets them.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::settings::{Key, Number, Settings, Values};
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;

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
