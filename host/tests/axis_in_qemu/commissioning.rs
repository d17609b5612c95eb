//! A new axis in QEMU, in lockstep: the same in every run, however busy the computer is.

#[path = "../support/commissioned.rs"]
mod commissioned;

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_blank_axis_is_commissioned_and_stays_so() {
    // Some minutes: identification twice, four feeds, and moves, at 2.7 s of the wall a second.
    if std::env::var_os("LEADSCREW_LONG").is_some() {
        commissioned::is_commissioned("qemu");
    }
}
