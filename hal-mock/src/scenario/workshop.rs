//! The machine that people learn on: the reference machine at rest, with switches on its travel, waiting for orders.

use super::definition::{Base, Scenario, Setting};

/// A travel with a home switch at its low end; the axis stands in between, and the index is far enough from the switch.
const SWITCHES: &[Setting] = &[
    setting("switches", "limit_low_mm", -60.0),
    setting("switches", "home_mm", -34.0),
    setting("switches", "limit_high_mm", 600.0),
    // A part on the table, for whoever probes; the axis may be driven into it.
    setting("touch_probe", "surface_mm", 15.0),
];

const fn setting(section: &'static str, key: &'static str, value: f64) -> Setting {
    Setting {
        section,
        key,
        value,
    }
}

/// What a machine in a workshop is made of; its axis is whatever firmware finds in its store.
#[must_use]
pub const fn workshop(base: Base, tick_hz: f64, seed: u64) -> Scenario<'static> {
    Scenario {
        base,
        machine: SWITCHES,
        tick_hz,
        seed,
        ..Scenario::QUIET
    }
}
