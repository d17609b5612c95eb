//! The rotary table at quarter and half turns, checked by hand.

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_process::deviations::{Component, Law, Machine, SettingVector, Table};
use nalgebra::Vector3;

use crate::machines::{bare, machine};

const URAD: f64 = 1e-6;

/// The machining centre whose only deviation is one of the rotary table, the same at all angles.
fn table_off(component: Component, value: f64) -> Machine {
    let mut machine = bare(0);
    let constant = vec![SettingVector::ZERO.with(component, value); 2];
    machine.workpiece[2].law = Law::table(Table::new(vec![0.0, 360.0], constant, true).unwrap());
    machine
}

fn at(x: f64, y: f64, z: f64, b: f64) -> Coordinates {
    Coordinates::xyz(x, y, z).with(Axis::B, b)
}

fn close(found: Vector3<f64>, expected: [f64; 3]) {
    let off = (found - Vector3::from(expected)).norm();
    assert!(off < 1e-12, "found {found:?}, expected {expected:?}");
}

/// The table's axis is tilted by 100 µrad about machine x: bound to the bed, not to the workpiece. The tip at X 0, Y 200, Z 0 is
/// (0, 200, 250) from the table's frame: tilt × place = 100e-6 · (0, −250, 200) mm for the workpiece, and the tool sees the
/// opposite, whatever B is.
#[test]
fn a_tilt_of_the_axis_stays_with_the_bed() {
    let machine = table_off(Component::Lambda, 100.0 * URAD);
    for b in [0.0, 90.0, 180.0, 270.0] {
        let delta = machine.deviation(&at(0.0, 200.0, 0.0, b)).unwrap();
        close(delta.shift, [0.0, 0.025, -0.020]);
        close(delta.turn, [-100.0 * URAD, 0.0, 0.0]);
    }
}

/// As the workpiece sees it, the same tilt goes round: at B 0 the tip is displaced along the workpiece's own z, after a quarter
/// turn of the table about −y machine z is the workpiece's +x... seen from the part.
#[test]
fn the_workpiece_sees_the_tilt_go_round() {
    let machine = table_off(Component::Lambda, 100.0 * URAD);
    let seen = |b| {
        let place = at(0.0, 200.0, 0.0, b);
        let actual = machine.true_tip(&place).unwrap().translation.vector;
        actual - machine.nominal_tip(&place).unwrap().translation.vector
    };
    // B turns the table by −B about y. Machine z in the frame of a part so turned is Rot(y, +B) z: z, x, −z, −x at the quarters.
    for (b, [x, y, z]) in [
        (0.0, [0.0, 0.025, -0.020]),
        (90.0, [-0.020, 0.025, 0.0]),
        (180.0, [0.0, 0.025, 0.020]),
        (270.0, [0.020, 0.025, 0.0]),
    ] {
        let off = (seen(b) - Vector3::new(x, y, z)).norm();
        assert!(off < 3e-6, "B {b}: {:?}", seen(b));
    }
}

/// A table that turns 100 µrad too far about +y moves what lies z = 250 mm from its axis by +0.025 mm in x: the tool sees −0.025.
/// The tip stays where it is in the machine, so this holds at every angle.
#[test]
fn an_angle_too_large_moves_the_part_under_the_tool() {
    let machine = table_off(Component::Beta, 100.0 * URAD);
    for b in [0.0, 90.0, 180.0] {
        let delta = machine.deviation(&at(0.0, 200.0, 0.0, b)).unwrap();
        close(delta.shift, [-0.025, 0.0, 0.0]);
    }
    // At X 100 the tip is 100 mm along x from the axis too, and sees +0.010 in z.
    let delta = machine.deviation(&at(100.0, 200.0, 0.0, 90.0)).unwrap();
    close(delta.shift, [-0.025, 0.0, 0.010]);
}

/// P4 (6): ψ takes the angle away, and with it all that follows from it. B turns the table about −y, so 100 µrad too far about +y
/// are undone by B + 0.00573°.
#[test]
fn psi_takes_an_angle_away_and_what_follows_from_it() {
    let machine = table_off(Component::Beta, 100.0 * URAD);
    let found = machine.correction(&at(100.0, 200.0, 0.0, 90.0)).unwrap();
    assert!((found.k[Axis::B] - (100.0 * URAD).to_degrees()).abs() < 1e-12);
    assert!(found.k.length_mm() < 1e-12 && found.left.shift.norm() < 1e-12);
}

/// An indexed table leaves the angle, and X and Z take the place away.
#[test]
fn a_table_that_cannot_turn_a_little_leaves_the_angle() {
    let mut machine = table_off(Component::Beta, 100.0 * URAD);
    machine.workpiece[2].corrected = false;
    let found = machine.correction(&at(100.0, 200.0, 0.0, 90.0)).unwrap();
    close(
        Vector3::new(found.k[Axis::X], found.k[Axis::Y], found.k[Axis::Z]),
        [0.025, 0.0, -0.010],
    );
    assert_eq!(found.k[Axis::B], 0.0);
    assert!((found.left.turn.y + 100.0 * URAD).abs() < 1e-15);
}

/// A spindle that turns freely displaces by the mean of a revolution only; placed by C, by what it has there.
#[test]
fn a_free_spindle_counts_by_its_axis_of_rotation() {
    let lathe = machine("lathe");
    let place = Coordinates::xyz(30.0, 0.0, 400.0);
    let free = &lathe.parts(&place).unwrap()[0].omega.to_array();
    assert_eq!(*free, [0.0, 0.0, 0.0, 14e-6, 9e-6, 0.0]);
    let placed = lathe.placing(Axis::C).unwrap();
    let at_90 = placed.parts(&place.with(Axis::C, 90.0)).unwrap()[0].omega;
    assert!((at_90.shift.x - (1.2e-3 + 0.3e-3 * 220f64.to_radians().sin())).abs() < 1e-12);
}
