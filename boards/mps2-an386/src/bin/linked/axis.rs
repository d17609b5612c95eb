//! The axis as it comes from the factory, and its machine.

use board_mps2_an386::simulated::Plant;
use leadscrew::settings::Settings;
use leadscrew::units::RangeError;
use leadscrew_hal_mock::scenario::{Scenario, ScenarioError, Setting, World, observer_params};

use crate::words::Words;

/// A travel with a home switch at its low end; the axis stands in between. The index is far enough from the switch.
const SWITCHES: &[Setting] = &[
    setting("switches", "limit_low_mm", -60.0),
    setting("switches", "home_mm", -34.0),
    setting("switches", "limit_high_mm", 600.0),
];
/// The axis seeks the switch where it is.
const HOMING: &[Setting] = &[setting("homing", "search_direction", -1.0)];

const fn setting(section: &'static str, key: &'static str, value: f64) -> Setting {
    Setting {
        section,
        key,
        value,
    }
}

/// What the axis is without anything stored: tuned on its machine.
pub fn factory(words: &Words) -> Result<Settings, ScenarioError> {
    let scenario = scenario(words, f64::from(words.options.tick_hz));
    let machine = scenario.plant().machine;
    Ok(Settings {
        axis: scenario.axis_params(&machine)?,
        observer: observer_params(&machine, scenario.mapped),
    })
}

/// A machine at rest on a board at which all is well.
pub fn plant(words: &Words, tick_hz: f64) -> Result<Plant, RangeError> {
    let scenario = scenario(words, tick_hz);
    World::new(&scenario.plant(), &scenario).map(Plant::World)
}

fn scenario(words: &Words, tick_hz: f64) -> Scenario<'static> {
    Scenario {
        base: words.machine,
        machine: SWITCHES,
        axis: HOMING,
        tick_hz,
        estimator: words.options.estimator,
        seed: words.seed,
        ..Scenario::QUIET
    }
}
