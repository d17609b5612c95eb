//! Every movement of a corrected program ends at its target plus K: rapids, changes of unit, offset and tool as well.

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::setup::Setup;
use leadscrew_nc::terms::Circumstances;

use super::rs274::{self, Canon, Control};
use super::true_path::{Case, corrected};
use crate::motion::Shape;

const MILL: &str = r#"
dialect = "linuxcnc-mill"
tolerance_mm = 0.003
[control]
start = { X = 0.0, Y = 0.0, Z = 0.0 }
[control.work_offsets]
origins.G54 = { X = 10.0, Y = 20.0, Z = 30.0 }
[control.tools.1]
offset = { Z = 50.0 }
[[terms.affine]]
name = "lean and bow"
constant_mm = { X = 0.01, Z = -0.02 }
coefficient = [
  { corrects = "X", by = "Y", mm_per_mm = 2e-4 },
  { corrects = "Y", by = "X", over = "X", places_mm = [-200, 200], mm_per_mm = [-2.1e-3, 1.9e-3] },
  { corrects = "Z", by = "X", mm_per_mm = 3e-4 },
]
"#;

const LATHE: &str = r#"
dialect = "linuxcnc-lathe"
tolerance_mm = 0.003
[control]
start = { X = 0.0, Y = 0.0, Z = 0.0 }
[control.work_offsets]
origins.G54 = { X = 10.0, Y = 20.0, Z = 30.0 }
[control.tools.1]
offset = { Z = 50.0 }
[[terms.affine]]
name = "taper"
constant_mm = { X = 0.005, Z = 0.01 }
coefficient = [
  { corrects = "X", by = "Z", over = "Z", places_mm = [-200, 200], mm_per_mm = [-3e-4, 5e-4] },
  { corrects = "Z", by = "X", mm_per_mm = -2e-4 },
]
"#;

fn case(setup: &'static str, program: &str) -> Case {
    Case {
        setup,
        files: |name| Err(name.to_owned()),
        program: program.to_owned(),
        control: Control {
            origin_mm: [10.0, 20.0, 30.0],
            // 50 mm and 4 mm.
            tools: "T1 P1 Z1.968503937008 D0.157480314961\n",
            start: Coordinates::ZERO,
        },
        cycles: &[],
    }
}

/// Movements of a program, and of what is made of it; none without the interpreter.
fn both(case: &Case) -> Option<(Vec<Canon>, Vec<Canon>, String)> {
    let corrected = corrected(case).unwrap_or_else(|error| panic!("{error}"));
    let text = String::from_utf8(corrected).unwrap();
    rs274::is_installed().then(|| {
        let meant = case.control.run(case.program.as_bytes());
        (meant, case.control.run(text.as_bytes()), text)
    })
}

fn with_k(case: &Case, place: &Coordinates) -> Coordinates {
    let terms = Setup::read(case.setup, &case.files).unwrap().terms;
    *place + terms.correction(place, &Circumstances::default()).unwrap()
}

/// Half a step of the words, and of what is printed.
fn is_near(one: &Canon, wanted: &Coordinates) -> bool {
    let off = one.motion.to - *wanted;
    off.iter().all(|(_, off)| off.abs() < 2.2 * one.printed_mm)
}

fn kind(one: &Canon) -> (bool, bool) {
    let is_arc = matches!(one.motion.shape, Shape::Arc { .. });
    (one.motion.is_feed, is_arc)
}

fn compare(case: &Case) {
    let Some((meant, real, text)) = both(case) else {
        return;
    };
    assert!(real.len() >= meant.len() && meant.len() > 5, "{text}");
    let mut reals = real.iter();
    for movement in &meant {
        let wanted = with_k(case, &movement.motion.to);
        // Pieces come between.
        let found = reals.find(|one| is_near(one, &wanted));
        let found = found
            .unwrap_or_else(|| panic!("{movement:?} should end at {wanted:?}: {real:#?}\n{text}"));
        assert_eq!(kind(found), kind(movement), "{text}");
    }
    assert_eq!(reals.count(), 0, "movements behind the last: {text}");
}

#[test]
fn milling() {
    compare(&case(
        MILL,
        "G21 G90 G54 G17\nT1 M6\nG43 H1\nG0 X0 Y0 Z20\nG1 Z-1 F100\nX80\nG91 Y30\nX-12.5 Z0.5\nG90\n\
         G2 X40 Y40 R40\nG3 X50 Y50 R10\nG3 I-10 Z-2\nG92 X0 Y0\nG1 X10 Y10\nG92.1\nX5 Y5\n\
         G20 X1 Y1.5\nG91 X.1\nG90 G21\nG53 G1 X60 Y60 Z70\nG0 X0 Y0 Z30\nG49\nG0 X0\nM2\n",
    ));
}

#[test]
fn turning() {
    compare(&case(
        LATHE,
        "G21 G90 G54 G18 G7\nT1 M6\nG43 H1\nG0 X60 Z5\nG1 X40 Z0 F100\nZ-20\nG2 X50 Z-25 I5 K0\nG3 X60 Z-30 R5\n\
         G1 G91 X-2 Z3\nG90 X20\nG8\nX18\nG7\nX30 Z-60\nG92 X30\nG1 X28\nG92.1\nG0 X60 Z5\nM2\n",
    ));
}

/// Only the bottoms of the holes are places that the program states.
#[test]
fn drilling() {
    let case = case(
        MILL,
        "G21 G90 G54 G17\nG0 X0 Y0 Z30\nG99 G81 X10 Y10 Z-5 R2 F50\nX70\nG98 G83 Y40 Z-8 R1 Q20\nX10\nG80\nM2\n",
    );
    let Some((meant, real, text)) = both(&case) else {
        return;
    };
    let bottoms = |all: Vec<Canon>| all.into_iter().filter(|one| one.motion.is_feed);
    let (meant, real): (Vec<_>, Vec<_>) = (bottoms(meant).collect(), bottoms(real).collect());
    assert_eq!((meant.len(), real.len()), (4, 4), "{text}");
    for (meant, real) in meant.iter().zip(&real) {
        let wanted = with_k(&case, &meant.motion.to);
        assert!(is_near(real, &wanted), "{real:?} {wanted:?}\n{text}");
        assert!(real.motion.to[Axis::Z] < 30.0);
    }
}
