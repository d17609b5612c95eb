//! The table of signals.

use leadscrew::scope::{Kind, Signal};

/// Part of the link: these are never changed, only added to.
const NUMBERS: [(u8, &str); 25] = [
    (1, "tick"),
    (2, "count"),
    (3, "position"),
    (4, "velocity"),
    (5, "acceleration"),
    (6, "setpoint_position"),
    (7, "setpoint_velocity"),
    (8, "setpoint_acceleration"),
    (9, "setpoint_jerk"),
    (10, "following_error"),
    (11, "command"),
    (12, "flags"),
    (13, "warnings"),
    (14, "state"),
    (15, "fault"),
    (16, "reported_position"),
    (17, "commanded_position"),
    (18, "experiment_position"),
    (19, "experiment_command"),
    (20, "friction_command"),
    (21, "master_count"),
    (22, "master_velocity"),
    (23, "illegal_transitions"),
    (24, "overrun_ticks"),
    (25, "ambiguous_ticks"),
];

#[test]
fn numbers_and_names_stay_and_lead_back() {
    let found: Vec<_> = Signal::ALL
        .iter()
        .map(|signal| (*signal as u8, signal.name()))
        .collect();
    assert_eq!(found, NUMBERS);
    for signal in Signal::ALL {
        assert_eq!(Signal::from_name(signal.name()), Some(*signal));
        assert_eq!(Signal::from_number(*signal as u8), Some(*signal));
        assert_eq!(signal.to_string(), signal.name());
        assert!(signal.kind() != Kind::Word || signal.frac() == 0);
    }
    assert_eq!(Signal::from_name("speed"), None);
    assert_eq!(Signal::from_number(0), None);
    assert_eq!(Signal::from_number(26), None);
}
