//! A new axis, set up by the command.

#[path = "../support/commissioned.rs"]
mod commissioned;

#[test]
fn a_blank_axis_is_commissioned_and_stays_so() {
    commissioned::is_commissioned("sim");
}
