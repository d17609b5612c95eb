//! Maps live in machine coordinates: every offset between them and the program is known, or asked for.

use leadscrew_nc::coordinates::Axis::{self, X, Y, Z};
use leadscrew_nc::machine_state::{MachineState, Places, Tool};

use super::correct_by;
use super::known_terms::slope;

fn places(values: &[(Axis, f64)]) -> Places {
    values.iter().copied().collect()
}

/// G54 at X 100, G55 at X 200, tool 1 of 50 mm; the axes at the machine's origin.
fn state() -> MachineState {
    let mut state = MachineState {
        start: places(&[(X, 0.0), (Y, 0.0), (Z, 0.0)]),
        ..MachineState::default()
    };
    let origins = &mut state.work_offsets.origins;
    origins.insert("G54".into(), places(&[(X, 100.0), (Y, 0.0), (Z, 0.0)]));
    origins.insert("G55".into(), places(&[(X, 200.0), (Y, 0.0), (Z, -10.0)]));
    let tool = Tool {
        offset: places(&[(Z, 50.0)]),
        radius_mm: Some(5.0),
    };
    state.tools.insert(1, tool);
    state
        .references
        .insert("G28".into(), places(&[(X, 500.0), (Y, 0.0), (Z, 0.0)]));
    state
}

/// Each block gives K = 0.001 of machine X, so that X words tell it.
fn x_by_x(program: &str) -> Result<String, String> {
    correct_by("linuxcnc-mill", &state(), slope(X, X, 0.001), program)
}

#[test]
fn work_offsets_and_their_changes() {
    assert_eq!(
        x_by_x("G0 X0\nG55 X0\nG54\nX100\n").unwrap(),
        "G0 X0.1\nG55 X0.2\nG54\nX100.2\n"
    );
    assert_eq!(
        x_by_x("G10 L2 P1 X300\nG0 X0\n").unwrap(),
        "G10 L2 P1 X300\nG0 X0.3\n"
    );
    assert_eq!(
        x_by_x("G0 X0\nG56 X0\n").unwrap_err(),
        "2:5: the origin of G56 in X is not known: give control.work_offsets.origins.G56.X in the setup"
    );
}

#[test]
fn shifts_and_local_origins() {
    // At X 100 (machine 200) X is called 0; then local 10.
    assert_eq!(
        x_by_x("G0 X100\nG92 X0\nX50\nG92.1\nX50\n").unwrap(),
        "G0 X100.2\nG92 X0\nX50.05\nG92.1\nX50.15\n"
    );
    assert_eq!(
        x_by_x("G52 X10\nG0 X0\nG52 X0\nX0\n").unwrap(),
        "G52 X10\nG0 X0.11\nG52 X0\nX0.1\n"
    );
    let iso = correct_by(
        "iso-mill",
        &state(),
        slope(X, X, 0.001),
        "G92X0\nG52X10.\nG0X0\nG52X0\nX0.\n",
    );
    // The axes stand at machine 0 = -100 of G54: X 0 of G92 is machine 0.
    assert_eq!(iso.unwrap(), "G92X0\nG52X10.\nG0X10\nG52X0\nX0.\n");
}

#[test]
fn machine_coordinates_position_the_machine_and_feed_the_work() {
    assert_eq!(
        x_by_x("G53 G0 X50\nG0 X0\nG53 G1 X50 F1\n").unwrap(),
        "G53 G0 X50\nG0 X0.1\nG53 G1 X50.05 F1\n"
    );
    assert!(
        x_by_x("G91 G53 G0 X5\n")
            .unwrap_err()
            .contains("G53 has no meaning while G91")
    );
}

#[test]
fn references_leave_the_axes_uncorrected_where_they_are() {
    // 500 - 100 in the program; the way from there starts without K.
    assert_eq!(
        x_by_x("G28 X10\nG91 G0 X-1\n").unwrap(),
        "G28 X10\nG91 G0 X-0.501\n"
    );
    let lost = x_by_x("G30\nG91 G0 X-1\n").unwrap_err();
    assert_eq!(
        lost,
        "2:8: the place of X is not known: give control.references.G30.X in the setup, or place the axis first"
    );
}

#[test]
fn tool_lengths_move_the_place_that_k_is_of() {
    let z = |program: &str| correct_by("linuxcnc-mill", &state(), slope(Z, Z, 0.001), program);
    assert_eq!(
        z("G43 H1\nG0 Z0\nG49\nZ0\n").unwrap(),
        "G43 H1\nG0 Z0.05\nG49\nZ0\n"
    );
    assert_eq!(z("T1 M6\nG43\nG0 Z0\n").unwrap(), "T1 M6\nG43\nG0 Z0.05\n");
    assert_eq!(z("G43.1 Z20\nG0 Z0\n").unwrap(), "G43.1 Z20\nG0 Z0.02\n");
    assert_eq!(
        z("G10 L1 P7 Z30\nG43 H7 G0 Z0\n").unwrap(),
        "G10 L1 P7 Z30\nG43 H7 G0 Z0.03\n"
    );
    assert_eq!(
        z("G43 H9\nG0 Z0\n").unwrap_err(),
        "2:4: the tool's offset in Z is not known: give control.tools.9.offset in the setup"
    );
    let negative = correct_by("iso-mill", &state(), slope(Z, Z, 0.001), "G44H1\nG0Z0\n");
    assert_eq!(negative.unwrap(), "G44H1\nG0Z-50\n");
}

#[test]
fn where_the_axes_stand_is_asked_for() {
    let mut state = state();
    state.start.remove(&Y);
    let refusal = correct_by("linuxcnc-mill", &state, slope(X, Y, 0.001), "G0 X5\n").unwrap_err();
    assert_eq!(
        refusal,
        "1:4: the place of Y is not known: give control.start.Y in the setup, or place the axis first"
    );
    assert!(correct_by("linuxcnc-mill", &state, slope(X, Y, 0.001), "G0 X5 Y0\n").is_ok());
}

#[test]
fn after_a_touch_the_place_is_where_the_probe_stopped() {
    assert_eq!(
        x_by_x("G0 X0\nG38.2 X50 F10\nG0 X10\n").unwrap(),
        "G0 X0.1\nG38.2 X50 F10\nG0 X10.11\n"
    );
    let refusal = x_by_x("G38.2 X50 F10\nG91 G0 X-1\n").unwrap_err();
    assert!(
        refusal.starts_with("2:8: the place of X is not known: place X by an absolute word"),
        "{refusal}"
    );
}

#[test]
fn a_tool_change_may_move_the_machine() {
    let mut state = state();
    state.tool_change = places(&[(X, 300.0)]);
    let out = correct_by(
        "linuxcnc-mill",
        &state,
        slope(X, X, 0.001),
        "T1 M6\nG91 G0 X1\n",
    );
    assert_eq!(out.unwrap(), "T1 M6\nG91 G0 X1.301\n");
}

#[test]
fn what_the_control_adds_to_all_offsets_counts() {
    let mut state = state();
    state.work_offsets.external = places(&[(X, 7.0)]);
    let program = "G0 X0\nG10 L2 P1 X300\nG0 X0\n";
    let out = correct_by("linuxcnc-mill", &state, slope(X, X, 0.001), program);
    assert_eq!(out.unwrap(), "G0 X0.107\nG10 L2 P1 X300\nG0 X0.307\n");
    state.work_offsets.external.clear();
    state.work_offsets.shift = places(&[(X, 20.0)]);
    let out = correct_by("linuxcnc-mill", &state, slope(X, X, 0.001), "G0 X0\n");
    assert_eq!(out.unwrap(), "G0 X0.12\n");
}

#[test]
fn a_tool_offset_may_come_on_top_of_another() {
    let program = "G43 H1\nG43.2 H1\nG0 Z0\n";
    let out = correct_by("linuxcnc-mill", &state(), slope(Z, Z, 0.001), program);
    assert_eq!(out.unwrap(), "G43 H1\nG43.2 H1\nG0 Z0.1\n");
}

#[test]
fn at_a_reference_nothing_is_left_of_what_was_applied() {
    assert_eq!(
        x_by_x("G0 X10\nG28 X10\nG91 G0 X-1\n").unwrap(),
        "G0 X10.11\nG28 X10\nG91 G0 X-0.501\n"
    );
    // The reference is set where the control really stands, 110.11.
    assert_eq!(
        x_by_x("G0 X10\nG28.1\nG28\nG91 G0 X-1\n").unwrap(),
        "G0 X10.11\nG28.1\nG28\nG91 G0 X-0.8909\n"
    );
}
