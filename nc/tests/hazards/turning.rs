//! Lathes: diameters, ways by U and W, turrets, noses.

use leadscrew_nc::coordinates::Axis::{X, Z};
use leadscrew_nc::machine_state::{MachineState, Tool};

use super::known_terms::{constant, slope};
use super::{control, correct, correct_by};

#[test]
fn k_is_doubled_on_diameters_and_i_stays_a_radius() {
    let terms = || constant(&[(X, 0.01)]);
    assert_eq!(
        correct("iso-lathe", terms(), "G0X50.Z2.\n"),
        "G0X50.02Z2.\n"
    );
    assert_eq!(
        correct("linuxcnc-lathe", terms(), "G0 X50\nG7\nX50\nG8\nX50\n"),
        "G0 X50.01\nG7\nX50.02\nG8\nX50.01\n"
    );
    // The way of U is a diameter too: from 20 mm of radius to 25 K grows by 0.05.
    assert_eq!(
        correct("iso-lathe", slope(X, X, 0.01), "G0X40.Z2.\nG1U10.F.2\n"),
        "G0X40.4Z2.\nG1U10.1F.2\n"
    );
    // An arc of a lathe: its ends are diameters, its centre is not.
    let out = correct("iso-lathe", terms(), "G0X40.Z0.\nG3X50.Z-5.I0.K-5.F.1\n");
    assert_eq!(out, "G0X40.02Z0.\nG3X50.02Z-5.I0.K-5.F.1\n");
    let out = correct(
        "linuxcnc-lathe",
        terms(),
        "G7\nG0 X40 Z0\nG90.1 G3 X50 Z-5 I20 K-5 F100\n",
    );
    assert_eq!(
        out,
        "G7\nG0 X40.02 Z0\nG90.1 G3 X50.02 Z-5 I20.01 K-5 F100\n"
    );
}

#[test]
fn the_control_may_begin_in_diameters_or_radii() {
    let state = MachineState {
        diameter: Some(false),
        ..control()
    };
    let out = correct_by("iso-lathe", &state, constant(&[(X, 0.01)]), "G0X50.Z2.\n");
    assert_eq!(out.unwrap(), "G0X50.01Z2.\n");
    let state = MachineState {
        diameter: Some(true),
        ..control()
    };
    let out = correct_by("linuxcnc-lathe", &state, constant(&[(X, 0.01)]), "G0 X50\n");
    assert_eq!(out.unwrap(), "G0 X50.02\n");
    let both = super::refused("linuxcnc-lathe", constant(&[(X, 0.01)]), "G7 X50\n");
    assert!(
        both.contains("G7 and G8 stand in a block without words of axes"),
        "{both}"
    );
}

#[test]
fn a_turret_takes_tool_and_offset_by_one_word() {
    let mut state = control();
    for (number, z) in [(1, 30.0), (12, 70.0)] {
        let tool = Tool {
            offset: [(X, 0.0), (Z, z)].into_iter().collect(),
            radius_mm: Some(0.4),
        };
        state.tools.insert(number, tool);
    }
    let turn = |program: &str| correct_by("iso-lathe", &state, slope(Z, Z, 0.001), program);
    assert_eq!(
        turn("T0101\nG0X50.Z0.\nT0212\nG0X50.Z0.\nT0200\nG0X9.Z0.\n").unwrap(),
        "T0101\nG0X50.Z0.03\nT0212\nG0X50.Z0.07\nT0200\nG0X9.Z0.\n"
    );
    let lost = turn("G0X50.Z0.\nT0101\nW-1.\n").unwrap_err();
    assert!(
        lost.starts_with("3:1: the place of Z is not known: place Z by an absolute word"),
        "{lost}"
    );
    let short = turn("T1\n").unwrap_err();
    assert!(
        short.starts_with("1:1: T is not two digits of the tool"),
        "{short}"
    );
}

#[test]
fn the_nose_must_not_make_k_uncertain() {
    let mut state = control();
    let tool = Tool {
        offset: [(X, 0.0), (Z, 0.0)].into_iter().collect(),
        radius_mm: Some(0.8),
    };
    state.tools.insert(1, tool);
    state.tools.insert(
        2,
        Tool {
            radius_mm: None,
            ..state.tools[&1].clone()
        },
    );
    let turn = |k1: f64, program: &str| correct_by("iso-lathe", &state, slope(Z, Z, k1), program);
    let program = "T0101\nG0X50.Z10.\nG42G1X40.Z0.F.1\nG40X60.\n";
    assert_eq!(
        turn(0.001, program).unwrap(),
        program.replace("Z10.", "Z10.01")
    );
    let steep = turn(0.01, program).unwrap_err();
    assert!(
        steep.starts_with("3:6: with a radius of 0.8 mm the correction is uncertain by 0.0080 mm"),
        "{steep}"
    );
    let unknown = turn(0.001, "T0202\nG0X50.Z10.\nG42G1X40.Z0.F.1\n").unwrap_err();
    assert_eq!(
        unknown,
        "3:6: the tool's radius is not known: give control.tools.2.radius_mm in the setup"
    );
    // One K everywhere does not care.
    let out = correct_by(
        "iso-lathe",
        &state,
        constant(&[(Z, 0.5)]),
        "T0202\nG0X50.Z10.\nG42G1X40.Z0.F.1\n",
    );
    assert!(out.is_ok());
}
