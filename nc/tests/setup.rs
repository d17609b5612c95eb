//! Setup files: what they say, and how what is wrong in them is told.

use leadscrew_nc::coordinates::{Axis, AxisSet, Coordinates};
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::setup::Setup;
use leadscrew_nc::terms::{Approach, Circumstances, Direction, Shape};

const SETUP: &str = r#"
dialect = "linuxcnc-mill"
tolerance_mm = 0.002
screw_map = { X = "program", Y = "board", Z = "nobody" }

[control]
start = { X = 0.0, Y = 0.0, Z = 200.0 }
tool = 3
tool_offset = 3
radius_tolerance_mm = 0.00127
[control.work_offsets]
active = "G54"
origins.G54 = { X = 100.0, Y = 50.0, Z = 20.0 }
[control.tools.3]
offset = { Z = 80.0 }
radius_mm = 5.0

[[terms.affine]]
name = "squareness"
datum_mm = { X = 0.0, Y = 200.0 }
constant_mm = { Z = 0.004 }
coefficient = [
    { corrects = "X", by = "Y", mm_per_mm = 2e-5 },
    { corrects = "Z", by = "X", over = "Y", places_mm = [0, 400], mm_per_mm = [0.0, 4e-5] },
]

[[terms.screw]]
axis = "X"
file = "screw-x.csv"

[[terms.grid]]
file = "volume.toml"

[[terms.thermal]]
name = "screw of Z warm"
axis = "Z"
grows = "screw"
expansion_um_per_m_k = 11.5
fixed_point_mm = 500.0
temperature_c = 26.0

[[terms.wear]]
tool = 3
offset_mm = { Z = -0.012 }

[[terms.workpiece]]
name = "clamping"
point_mm = { X = 100, Y = 50, Z = 0 }
a_mm = 0.05
gamma_rad = 0.001
"#;

const SCREW: &str = "position_mm,forward_um,backward_um\n-10,0,6\n400,20.5,26.5\n";

const VOLUME: &str = "name = \"volume\"\n\
                      over = [{ axis = \"Z\", places_mm = [0, 400] }]\n\
                      correct = [{ axis = \"Y\", values_mm = [0.0, 0.02] }]\n";

fn files(name: &str) -> Result<String, String> {
    match name {
        "screw-x.csv" => Ok(SCREW.to_owned()),
        "volume.toml" => Ok(VOLUME.to_owned()),
        "bad.toml" => Ok(VOLUME.replace("[0, 400]", "[400, 0]")),
        _ => Err(format!("{name}: cannot be read")),
    }
}

fn read(text: &str) -> Result<Setup, String> {
    Setup::read(text, &files).map_err(|complaint| complaint.to_string())
}

fn with_tool(direction: Direction) -> Circumstances {
    Circumstances {
        tool: Some(3),
        tool_offset: Some(Coordinates::xyz(0.0, 0.0, 80.0)),
        approach: Approach::UNKNOWN.with(Axis::X, direction),
    }
}

#[test]
fn a_setup_gives_dialect_control_tolerance_and_the_sum_of_its_terms() {
    let setup = read(SETUP).unwrap();
    assert_eq!(
        setup.dialect.as_ref().map(Dialect::name),
        Some("linuxcnc-mill")
    );
    assert_eq!(setup.tolerance.mm, 0.002);
    assert_eq!(setup.control.tools[&3].radius_mm, Some(5.0));
    assert_eq!(setup.terms.shape(), Shape::Curved);
    assert_eq!(setup.terms.corrects().to_string(), "XYZ");
    assert_eq!(setup.terms.depends_on_approach_of(), AxisSet::of(Axis::X));
    assert!(setup.terms.depends_on_tool());

    let at = Coordinates::xyz(195.0, 300.0, 100.0);
    let k = setup
        .terms
        .correction(&at, &with_tool(Direction::Down))
        .unwrap();
    // Squareness 2e-5 × 100; screw half of 6…26.5 µm; clamping: 0.05 − (300 − 50)·sin 1 mrad − (195 − 100)(1 − cos 1 mrad).
    let clamping = 0.05 - 250.0 * 0.001_f64.sin() - 95.0 * (1.0 - 0.001_f64.cos());
    assert!(
        (k[Axis::X] - (0.002 - 0.01625 + clamping)).abs() < 1e-12,
        "{k:?}"
    );
    let clamping = 95.0 * 0.001_f64.sin() - 250.0 * (1.0 - 0.001_f64.cos());
    assert!((k[Axis::Y] - (0.005 + clamping)).abs() < 1e-12, "{k:?}");
    // Constant 4 µm; 3e-5 × 195; screw of Z −400 mm from its fixed point, 69 ppm; wear −12 µm.
    let warm = 400.0 * 69e-6 / (1.0 + 69e-6);
    assert!(
        (k[Axis::Z] - (0.004 + 3e-5 * 195.0 + warm - 0.012)).abs() < 1e-12,
        "{k:?}"
    );
}

#[test]
fn each_term_alone_sums_up_to_the_whole() {
    let setup = read(SETUP).unwrap();
    let at = Coordinates::xyz(195.0, 300.0, 100.0);
    let with = with_tool(Direction::Up);
    let each = setup.terms.each(&at, &with).unwrap();
    let names: Vec<_> = each.iter().map(|(name, _)| *name).collect();
    assert_eq!(
        names,
        [
            "squareness",
            "volume",
            "screw X",
            "screw of Z warm",
            "clamping",
            "tool wear"
        ]
    );
    let sum = each.iter().fold(Coordinates::ZERO, |sum, (_, k)| sum + *k);
    assert!((sum - setup.terms.correction(&at, &with).unwrap()).length_mm() < 1e-15);
}

#[test]
fn terms_that_lack_something_say_what() {
    let setup = read(SETUP).unwrap();
    let at = Coordinates::xyz(195.0, 300.0, 100.0);
    let message = |at: &Coordinates, with: &Circumstances| {
        setup.terms.correction(at, with).unwrap_err().to_string()
    };
    let all = with_tool(Direction::Up);
    let no_tool = Circumstances { tool: None, ..all };
    assert!(message(&at, &no_tool).contains("\"tool wear\" depends on the tool"));
    let no_offset = Circumstances {
        tool_offset: None,
        ..all
    };
    assert!(message(&at, &no_offset).contains("\"clamping\" depends on where the tool's tip is"));
    let no_way = Circumstances {
        approach: Approach::UNKNOWN,
        ..all
    };
    assert!(message(&at, &no_way).contains("\"screw X\" needs to know from which side X came"));
    let out = at.with(Axis::Y, 401.0);
    assert!(
        message(&out, &all).contains("Y = 401.0000 mm"),
        "{}",
        message(&out, &all)
    );
}

#[test]
fn what_is_wrong_is_told_with_line_and_column() {
    for (from, to, message) in [
        (
            "tolerance_mm = 0.002",
            "tolerance_mm = 20",
            "3:16: tolerance_mm = 20 mm is out of range: allowed are 0.00001 to 1 mm",
        ),
        (
            "linuxcnc-mill",
            "linuxcnc",
            "2:11: dialect = \"linuxcnc\" is not known: expected one of iso-mill",
        ),
        ("linuxcnc-mill", "my.toml", "2:11: my.toml: cannot be read"),
        (
            "mm_per_mm = 2e-5",
            "mm_per_deg = 2e-5",
            "mm_per_deg: a coefficient of X by Y is stated as mm_per_mm",
        ),
        (
            "mm_per_mm = 2e-5",
            "mm_per_mm = 20",
            "mm_per_mm = 20 mm/mm is out of range",
        ),
        (
            "mm_per_mm = 2e-5 ",
            "",
            "23:5: one value is needed, mm_per_mm = …",
        ),
        (", over = \"Y\"", "", "needs over = \"axis\""),
        (
            "places_mm = [0, 400]",
            "places_deg = [0, 400]",
            "over = \"Y\" needs places_mm",
        ),
        ("[0.0, 4e-5]", "[0.0]", "1 values for 2 places"),
        (
            "volume.toml",
            "bad.toml",
            "32:8: bad.toml:2:9: the places of Z must rise",
        ),
        (
            "screw-x.csv",
            "volume.toml",
            "is not known: expected position_mm, forward_um, backward_um",
        ),
        (
            "axis = \"X\"\nfile",
            "axis = \"A\"\nfile",
            "28:8: axis = \"A\": a screw map is of a linear axis",
        ),
        ("file = \"screw-x.csv\"", "", "needs either file"),
        (
            "temperature_c = 26.0",
            "temperature_c = 260",
            "temperature_c = 260 degC is out of range",
        ),
        (
            "offset_mm = { Z = -0.012 }",
            "offset_mm = { Z = -12 }",
            "offset_mm: Z = -12 mm is out of range",
        ),
        (
            "offset_mm = { Z = -0.012 }",
            "nose_radius_mm = -0.01",
            "needs orientation = 1 to 9",
        ),
        (
            "gamma_rad = 0.001",
            "gamma_rad = 5",
            "gamma_rad = 5 rad is out of range: allowed are -0.8 to 0.8 rad",
        ),
        ("gamma_rad", "gamma_deg", "unknown field `gamma_deg`"),
        (
            "\"clamping\"",
            "\"squareness\"",
            "two terms are named \"squareness\"",
        ),
        (
            "start = { X = 0.0",
            "start = { X = 1e9",
            "control: X = 1000000000 mm is out of range",
        ),
    ] {
        assert!(SETUP.contains(from), "{from}");
        let error = read(&SETUP.replacen(from, to, 1)).unwrap_err();
        assert!(error.contains(message), "{from} -> {to}: {error}");
        assert!(
            error
                .split(':')
                .next()
                .is_some_and(|line| line.parse::<usize>().is_ok()),
            "{error}"
        );
    }
}

#[test]
fn a_screw_map_has_one_owner() {
    let stated = "screw_map = { X = \"program\", Y = \"board\", Z = \"nobody\" }";
    for (owner, message) in [
        (
            "screw_map = \"board\"",
            "\"screw X\" corrects the screw of X, and the board already does",
        ),
        ("screw_map = \"control\"", "the control already does"),
        ("screw_map = \"nobody\"", "screw_map says that nobody does"),
        ("", "state that neither board nor control does"),
        (
            "screw_map = { X = \"program\", Z = \"program\" }",
            "leaves the screw of Z to the program",
        ),
    ] {
        let error = read(&SETUP.replace(stated, owner)).unwrap_err();
        assert!(error.contains(message), "{owner}: {error}");
    }
    assert!(read(&SETUP.replace(stated, "screw_map = \"program\"")).is_ok());
    let none = "screw_map = \"program\"\n";
    assert!(read(none).unwrap_err().contains("no term corrects it"));
    assert!(read("screw_map = \"board\"\n").is_ok());

    // A grid that includes the drives' errors is a second owner too.
    let with_drives = |name: &str| {
        let drives = VOLUME
            .replace("over =", "includes_drive_errors = true\nover =")
            .replace("\"Y\"", "\"X\"");
        if name == "volume.toml" {
            Ok(drives)
        } else {
            files(name)
        }
    };
    let error = Setup::read(SETUP, &with_drives).unwrap_err().to_string();
    assert!(
        error.contains("the screw of X is corrected twice, by \"volume\" and by \"screw X\""),
        "{error}"
    );
}

#[test]
fn a_term_for_an_axis_that_the_dialect_has_not_is_refused() {
    let setup = read(SETUP).unwrap();
    assert!(
        setup
            .check_axes(&Dialect::named("linuxcnc-mill").unwrap())
            .is_ok()
    );
    let turned =
        read("\n[[terms.affine]]\nname = \"pallet\"\nconstant_deg = { B = 0.001 }\n").unwrap();
    let lathe = Dialect::named("iso-lathe").unwrap();
    let error = turned.check_axes(&lathe).unwrap_err().to_string();
    assert_eq!(
        error,
        "2:1: term \"pallet\" corrects B, which dialect iso-lathe has not: its axes are XYZAC"
    );
}

#[test]
fn a_worn_nose_moves_the_tip_to_the_work() {
    let text = "[[terms.wear]]\ntool = 1\nnose_radius_mm = -0.01\norientation = 2\n\
                [[terms.wear]]\ntool = 2\noffset_mm = { X = 0.003 }\nnose_radius_mm = -0.01\norientation = 5\n";
    let setup = read(text).unwrap();
    let k = |tool| {
        let with = Circumstances {
            tool: Some(tool),
            ..Circumstances::default()
        };
        setup.terms.correction(&Coordinates::ZERO, &with).unwrap()
    };
    // Orientation 2 cuts towards smaller X and Z; 5 towards larger Z.
    assert_eq!(k(1), Coordinates::xyz(-0.01, 0.0, -0.01));
    assert_eq!(k(2), Coordinates::xyz(0.003, 0.0, 0.01));
    assert_eq!(k(7), Coordinates::ZERO);
    assert_eq!(setup.terms.shape(), Shape::Constant);
    let twice = read(&text.replace("tool = 2", "tool = 1")).unwrap_err();
    assert!(twice.starts_with("5:1: tool 1 is worn twice"), "{twice}");
}
