//! The path that the interpreter makes of a corrected program is that of the original plus K, everywhere within the tolerance.

use std::path::Path;

use leadscrew_nc::coordinates::{Axis, Coordinates};

use super::rs274::{self, Control};
use super::true_path::{Case, check, corrected};

fn example(name: &str) -> Result<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/examples/correct");
    std::fs::read_to_string(folder.join(name)).map_err(|error| error.to_string())
}

#[test]
fn the_example_of_the_docs() {
    check(&Case {
        setup: include_str!("../../../../docs/examples/correct/setup.toml"),
        files: example,
        program: example("plate.ngc").unwrap(),
        control: Control {
            origin_mm: [100.0, 80.0, 60.0],
            tools: "T3 P3 Z3.149606299212598\n",
            start: Coordinates::xyz(0.0, 0.0, 290.0),
        },
        cycles: &["N280", "N290"],
    });
}

const LATHE: &str = r#"
dialect = "linuxcnc-lathe"
tolerance_mm = 0.001
screw_map = "program"
[control]
start = { X = 50.0, Y = 0.0, Z = 100.0 }
tool = 0
tool_offset = 0
radius_tolerance_mm = 0.00127
[control.work_offsets]
active = "G54"
origins.G54 = { X = 2.0, Y = 0.0, Z = 30.0 }
[[terms.screw]]
axis = "X"
points = [
  { position_mm = -10, forward_um = 0, backward_um = 12 },
  { position_mm = 20, forward_um = 9, backward_um = 19 },
  { position_mm = 60, forward_um = 15, backward_um = 22 },
]
[[terms.screw]]
axis = "Z"
points = [
  { position_mm = -60, forward_um = -20, backward_um = -25 },
  { position_mm = 0, forward_um = 0, backward_um = -5 },
  { position_mm = 150, forward_um = 14, backward_um = 8 },
]
[[terms.affine]]
name = "bed not parallel to the spindle"
datum_mm = { Z = 30.0 }
coefficient = [{ corrects = "X", by = "Z", mm_per_mm = -2e-4 }]
"#;

const TURNED: &str = "%
G21 G18 G7 G90 G40 G49 G54 G94
S600 M3
N10 G0 X70 Z5
N20 G1 X40 F200
N30 Z-20
N40 X50 Z-35 (taper)
N50 G2 X70 Z-45 R10
N60 G1 Z-50
N70 G0 X80
N80 Z5
N90 X20
N100 G1 Z0 F100
N110 G3 X40 Z-10 I0 K-10
N120 G1 Z-15
N130 G91
N140 G1 X4 Z-2
N150 X-4 Z-2
N160 G2 X4 Z-2 I2 K0
N170 G90 G8
N180 G1 X30 Z-25
N190 G0 X40
N200 M2
%
";

#[test]
fn a_lathe_in_diameters_and_radii_absolute_and_incremental() {
    check(&Case {
        setup: LATHE,
        files: |name| Err(name.to_owned()),
        program: TURNED.to_owned(),
        control: Control {
            origin_mm: [2.0, 0.0, 30.0],
            tools: "",
            start: Coordinates::xyz(50.0, 0.0, 100.0),
        },
        cycles: &[],
    });
}

#[test]
fn an_arc_is_where_it_should_be_axis_by_axis() {
    // Against a hand value: K = 0.1 mm in X alone moves centre and end of a full circle by that.
    let case = Case {
        setup: "dialect = \"linuxcnc-mill\"\n[control]\nstart = { X = 0.0, Y = 0.0, Z = 0.0 }\n\
                [control.work_offsets]\norigins.G54 = { X = 0.0, Y = 0.0, Z = 0.0 }\n\
                [[terms.affine]]\nname = \"x\"\nconstant_mm = { X = 0.1 }\n",
        files: |name| Err(name.to_owned()),
        program: "G21 G90 G17 G94 G54\nF100\nG1 X10 Y0 Z0\nG2 I-10\nM2\n".to_owned(),
        control: Control {
            origin_mm: [0.0; 3],
            tools: "",
            start: Coordinates::ZERO,
        },
        cycles: &[],
    };
    let corrected = corrected(&case).unwrap_or_else(|error| panic!("{error}"));
    if !rs274::is_installed() {
        return;
    }
    let canons = case.control.run(&corrected);
    for place in canons.last().unwrap().motion.samples() {
        let radius = (place[Axis::X] - 0.1).hypot(place[Axis::Y]);
        assert!((radius - 10.0).abs() < 2e-4, "{place:?}");
    }
}
