//! A new axis in QEMU, in lockstep: the same in every run, however busy the computer is.

#[path = "../support/commissioned.rs"]
mod commissioned;

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_blank_axis_is_commissioned_and_stays_so() {
    commissioned::is_commissioned("qemu");
}
