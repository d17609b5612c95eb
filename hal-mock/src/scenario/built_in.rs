//! Scenarios that the firmware has in it, for want of files: those of `tests/scenarios` of the same names.

use super::action::{Action, Ask, Timed, Trouble};
use super::definition::Scenario;

/// All of them, by name.
pub const BUILT_IN: &[(&str, Scenario<'static>)] = &[
    ("retarget-and-hold", RETARGET_AND_HOLD),
    ("drive-fault", DRIVE_FAULT),
];

/// The built-in scenario of that name.
#[must_use]
pub fn built_in(name: &str) -> Option<&'static Scenario<'static>> {
    BUILT_IN
        .iter()
        .find(|(known, _)| *known == name)
        .map(|(_, scenario)| scenario)
}

const fn ask(at_s: f64, ask: Ask) -> Timed {
    Timed {
        at_s,
        action: Action::Ask(ask),
    }
}

const fn move_to(at_s: f64, position_mm: f64) -> Timed {
    let feed_mm_per_min = 0.0;
    ask(
        at_s,
        Ask::MoveTo {
            position_mm,
            feed_mm_per_min,
        },
    )
}

const RETARGET_AND_HOLD: Scenario<'static> = Scenario {
    duration_s: 3.5,
    timeline: &[
        ask(0.0, Ask::Enable),
        move_to(0.2, 60.0),
        move_to(0.5, -20.0),
        ask(0.8, Ask::Hold),
        ask(1.2, Ask::Resume),
        ask(1.4, Ask::Override { percent: 50 }),
        ask(1.7, Ask::Override { percent: 150 }),
    ],
    ..Scenario::QUIET
};

const DRIVE_FAULT: Scenario<'static> = Scenario {
    duration_s: 1.6,
    timeline: &[
        ask(0.0, Ask::Enable),
        ask(
            0.2,
            Ask::MoveBy {
                distance_mm: 200.0,
                feed_mm_per_min: 0.0,
            },
        ),
        Timed {
            at_s: 0.7,
            action: Action::Trouble {
                trouble: Trouble::DriveFault,
                for_s: f64::INFINITY,
            },
        },
    ],
    ..Scenario::QUIET
};
