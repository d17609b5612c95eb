//! Tool lengths: whose they are where G43 has no H, and where H stands alone.

use leadscrew_nc::coordinates::Axis;
use leadscrew_nc::machine_state::Tool;

use super::known_terms::slope;
use super::{control, correct_by};

/// Z grows by a thousandth, machine coordinates; tool 3 is 80 mm long, tool 4 50 mm.
fn correct(dialect: &str, program: &str) -> Result<String, String> {
    let mut state = control();
    for (number, length) in [(3, 80.0), (4, 50.0)] {
        let tool = Tool {
            offset: [(Axis::Z, length)].into(),
            radius_mm: None,
        };
        state.tools.insert(number, tool);
    }
    correct_by(dialect, &state, slope(Axis::Z, Axis::Z, 1e-3), program)
}

#[test]
fn a_length_without_h_is_that_of_the_tool_in_use_where_the_dialect_says_so() {
    assert_eq!(
        correct("linuxcnc-mill", "T3 M6\nG43\nG0 Z20\n").unwrap(),
        "T3 M6\nG43\nG0 Z20.1\n"
    );
    // Elsewhere it is that of the last H, which the program may have had before its offset was taken off.
    let refusal = correct("iso-mill", "T3M6\nG43G0Z20.\n").unwrap_err();
    assert!(
        refusal
            .starts_with("2:6: the tool's offset in Z is not known: give the tool's number by H"),
        "{refusal}"
    );
    assert_eq!(
        correct("iso-mill", "T3M6\nG43H3G0Z20.\n").unwrap(),
        "T3M6\nG43H3G0Z20.1\n"
    );
}

#[test]
fn h_alone_is_refused_where_it_takes_another_length() {
    let refusal = correct("iso-mill", "G43H3G0Z20.\nH4Z20.\n").unwrap_err();
    assert!(
        refusal.starts_with("2:1: H alone brings another tool length into force"),
        "{refusal}"
    );
    assert!(correct("iso-mill", "G43H3G0Z20.\nH3Z20.\n").is_ok());
    assert!(correct("iso-mill", "G43H3G0Z20.\nG43H4Z20.\nG49H5\nH4\n").is_ok());
    // LinuxCNC knows H beside G43 alone.
    assert!(correct("linuxcnc-mill", "G43 H3\nG0 Z20 H4\n").is_ok());
}
