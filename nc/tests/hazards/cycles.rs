//! Canned cycles: Z is a place, R, Q and the rest are not; holes that need another depth; threads.

use leadscrew_nc::coordinates::Axis::{X, Y, Z};

use super::known_terms::{constant, slope, square};
use super::{correct, refused};

#[test]
fn drilling_corrects_x_y_and_the_bottom() {
    let terms = || constant(&[(X, 0.01), (Z, -0.02)]);
    let from = "G0 X0 Y0 Z50\nG98 G83 X10 Y10 Z-20 R2 Q5 F100\nX20\nG80\nG0 Z50\n";
    let to = "G0 X0.01 Y0 Z49.98\nG98 G83 X10.01 Y10 Z-20.02 R2 Q5 F100\nX20.01\nG80\nG0 Z49.98\n";
    assert_eq!(correct("linuxcnc-mill", terms(), from), to);
    let from = "G0X0Y0Z50.\nG99G81X10.Y10.Z-20.R2.P100F100\nG80Z50.\n";
    let to = "G0X10Y0Z49.98\nG99G81X10.01Y10.Z-20.02R2.P100F100\nG80Z49.98\n";
    assert_eq!(correct("iso-mill", terms(), from), to);
}

#[test]
fn a_hole_that_needs_another_depth_gets_its_own_z() {
    let terms = || slope(Z, X, 0.001);
    let from = "G0 X0 Y0 Z50\nG99 G81 X10 Z-20 R2 F100\nX20\nX20 Y5\nX0\n";
    let to = "G0 X0 Y0 Z50\nG99 G81 X10 Z-19.99 R2 F100\nX20 Z-19.98\nX20 Y5\nX0 Z-20\n";
    assert_eq!(correct("linuxcnc-mill", terms(), from), to);
}

#[test]
fn after_drilling_z_is_at_r_or_where_it_began() {
    let terms = || slope(Z, X, 0.001);
    // At R, which stays 2; the next movement takes K up again.
    let out = correct(
        "linuxcnc-mill",
        terms(),
        "G0 X10 Z50\nG99 G81 X10 Z-20 R2 F100\nG80\nG0 X10 Y5\n",
    );
    assert_eq!(
        out,
        "G0 X10 Z50.01\nG99 G81 X10 Z-19.99 R2 F100\nG80\nG0 X10 Y5 Z2.01\n"
    );
    let out = correct(
        "linuxcnc-mill",
        terms(),
        "G0 X10 Z50\nG98 G81 X10 Z-20 R2 F100\nG80\nG0 X10 Y5\n",
    );
    assert_eq!(
        out,
        "G0 X10 Z50.01\nG98 G81 X10 Z-19.99 R2 F100\nG80\nG0 X10 Y5\n"
    );
}

#[test]
fn drilling_by_ways() {
    // R -48 from 50, Z -22 from there: the bottom at -20 of X 110, 120.
    let terms = || slope(Z, X, 0.001);
    let from = "G0 X100 Y0 Z50\nG91 G99 G81 X10 R-48 Z-22 F100\nG80\n";
    let out = correct("linuxcnc-mill", terms(), from);
    assert_eq!(
        out,
        "G0 X100 Y0 Z50.1\nG91 G99 G81 X10 R-48 Z-21.99 F100\nG80\n"
    );
    let repeated = refused("linuxcnc-mill", terms(), "G91 G81 X10 R-1 Z-2 L5 F100\n");
    assert!(repeated.contains("a cycle repeated by ways"), "{repeated}");
}

/// Controls differ in what they make of it.
#[test]
fn a_depth_or_r_of_before_g90_or_g91_is_asked_for_anew() {
    let terms = || slope(Z, X, 0.001);
    let holding =
        "a word of the cycle that holds from before G90 or G91: write it again in this block";
    for second in ["G91 X10", "G91 X10 Z-22", "G91 X10 R-1"] {
        let program = format!("G0 X100 Y0 Z50\nG99 G81 X110 Z-20 R2 F100\n{second}\n");
        let refusal = refused("linuxcnc-mill", terms(), &program);
        assert!(
            refusal.starts_with("3:") && refusal.contains(holding),
            "{refusal}"
        );
    }
    let refusal = refused(
        "linuxcnc-mill",
        terms(),
        "G0 X100 Y0 Z50\nG91 G99 G81 X10 R-48 Z-22 F100\nG90 X120\n",
    );
    assert!(refusal.contains(holding), "{refusal}");
    // R stays 2, so the way to the bottom at X 120 has all of K.
    let out = correct(
        "linuxcnc-mill",
        terms(),
        "G0 X100 Y0 Z50\nG99 G81 X110 Z-20 R2 F100\nG91 X10 Z-22 R-1\n",
    );
    assert!(out.ends_with("\nG91 X10 Z-21.88 R-1\n"), "{out}");
}

#[test]
fn threading_of_linuxcnc_corrects_its_end_alone() {
    let terms = || constant(&[(X, 0.01), (Z, 0.02)]);
    let from = "G0 X20 Z5\nG76 P1.5 Z-30 I-2 J0.3 R1.5 K1 Q29.5 H2 E1 L2\nG0 X30\n";
    let to = "G0 X20.01 Z5.02\nG76 P1.5 Z-29.98 I-2 J0.3 R1.5 K1 Q29.5 H2 E1 L2\nG0 X30.01\n";
    assert_eq!(correct("linuxcnc-lathe", terms(), from), to);
    let from = "G0 X20 Z5\nG33 Z-30 K1.5\nG0 X30\n";
    let to = "G0 X20.01 Z5.02\nG33 Z-29.98 K1.5\nG0 X30.01\n";
    assert_eq!(correct("linuxcnc-lathe", terms(), from), to);
}

#[test]
fn cycles_of_iso_lathes() {
    let terms = || constant(&[(X, 0.01), (Z, 0.02)]);
    for (from, to) in [
        // Threading in two blocks; R, P and Q are no places.
        (
            "G76P020060Q100R.05\nG76X18.16Z-30.R0P920Q300F1.5\n",
            "G76P020060Q100R.05\nG76X18.18Z-29.98R0P920Q300F1.5\n",
        ),
        // A box, its following blocks, and back to G1.
        (
            "G90X45.Z-20.F.2\nX40.\nG0X60.\n",
            "G90X45.02Z-19.98F.2\nX40.02\nG0X60.02\n",
        ),
        (
            "G92X19.Z-20.F1.5\nX18.5\n",
            "G92X19.02Z-19.98F1.5\nX18.52\n",
        ),
        ("G94X10.Z-1.F.2\nZ-2.\n", "G94X10.02Z-0.98F.2\nZ-1.98\n"),
        (
            "G75R1.\nG75X30.Z-20.P2000Q3000F.1\n",
            "G75R1.\nG75X30.02Z-19.98P2000Q3000F.1\n",
        ),
        ("G90U-15.W-25.F.2\n", "G90U-15.W-25.F.2\n"),
    ] {
        let (before, after) = ("G0X60.Z5.\n", "G0X60.02Z5.02\n");
        assert_eq!(
            correct("iso-lathe", terms(), &format!("{before}{from}")),
            format!("{after}{to}")
        );
    }
}

#[test]
fn a_box_comes_back_to_its_start() {
    let out = correct(
        "iso-lathe",
        slope(X, Z, 0.0001),
        "G0X60.Z0.\nG90X45.Z-10.F.2\nG0U2.\n",
    );
    // At Z -10 K is -0.001 of radius; back at Z 0 nothing is left of it.
    assert_eq!(out, "G0X60.Z0.\nG90X44.998Z-10.F.2\nG0U2.\n");
}

#[test]
fn allowances_of_roughing_are_no_places_and_its_profile_is_read_like_any_block() {
    let from = "G0X100.Z5.\nG71U2.R.5\nG71P10Q20U.4W.1F.2\nN10G0X20.\nG1Z-30.\nN20X100.\nG70P10Q20\nG0W10.\n";
    let to = "G0X100.Z5.05\nG71U2.R.5\nG71P10Q20U.4W.1F.2\nN10G0X20.\nG1Z-30.3\nN20X100.\nG70P10Q20\nG0W10.1\n";
    assert_eq!(correct("iso-lathe", slope(Z, Z, 0.01), from), to);
}

#[test]
fn a_thread_along_which_k_changes_too_much_is_refused() {
    let steep = refused(
        "linuxcnc-lathe",
        slope(X, Z, 0.001),
        "G0 X20 Z5\nG76 P1.5 Z-30 I-2 J0.3 K1\n",
    );
    assert!(
        steep.starts_with(
            "2:10: the correction changes along the cut of the cycle by 17.5 times the tolerance"
        ),
        "{steep}"
    );
    let curved = refused(
        "linuxcnc-lathe",
        square(X, Z, 0.001),
        "G0 X20 Z5\nG33 Z-30 K1.5\n",
    );
    assert!(curved.contains("which must not be in a thread"), "{curved}");
}

#[test]
fn cycles_in_other_planes_and_with_other_axes_are_refused() {
    let plane = refused(
        "linuxcnc-mill",
        constant(&[(Y, 1.0)]),
        "G18\nG81 X1 Z-1 R1\n",
    );
    assert!(
        plane.starts_with("2:5: a drilling cycle is known in plane X, Y"),
        "{plane}"
    );
    let axis = refused("linuxcnc-mill", constant(&[(Y, 1.0)]), "G81 X1 Z-1 R1 U5\n");
    assert!(
        axis.starts_with("1:15: U has no meaning with the cycle"),
        "{axis}"
    );
}
