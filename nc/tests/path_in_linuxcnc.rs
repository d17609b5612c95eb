//! Corrected programs through LinuxCNC's own interpreter, where it is installed: the path it makes of a corrected program is the
//! path of the original plus K, everywhere within the tolerance. Without it these tests say so and pass.

#[path = "support/linuxcnc.rs"]
mod linuxcnc;
#[path = "support/random_programs.rs"]
mod random_programs;

use std::io::BufReader;
use std::path::Path;

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::corrector::{self, Corrector};
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::setup::Setup;
use leadscrew_nc::terms::{Approach, Circumstances};
use linuxcnc::{Control, Motion};

/// Half a step of the words, 0.0001 mm, on three axes and in I, J.
const ROUNDING_MM: f64 = 0.0003;

struct Case {
    setup: &'static str,
    files: fn(&str) -> Result<String, String>,
    program: String,
    control: Control,
    /// Blocks whose movements are those of cycles: only where their feeds end is compared.
    cycles: &'static [&'static str],
}

/// The corrected program, or why it is refused.
fn corrected(case: &Case) -> Result<Vec<u8>, String> {
    let setup = Setup::read(case.setup, &case.files).unwrap();
    let dialect: Dialect = setup.dialect.unwrap();
    let mut corrector =
        Corrector::new(dialect, &setup.control, setup.terms, setup.tolerance).unwrap();
    let mut out = Vec::new();
    let reader = BufReader::new(case.program.as_bytes());
    corrector::correct(reader, &mut out, &mut corrector).map_err(|error| error.to_string())?;
    Ok(out)
}

/// Where the tool goes by the program plus K, finely sampled, feeds only.
fn true_path(case: &Case, motions: &[Motion]) -> (Vec<Coordinates>, Vec<Coordinates>) {
    let setup = Setup::read(case.setup, &case.files).unwrap();
    let mut with = Circumstances {
        tool: setup.control.tool,
        ..Circumstances::default()
    };
    let (mut path, mut cycle_ends) = (Vec::new(), Vec::new());
    for motion in motions {
        with.tool = motion.tool.or(with.tool);
        with.tool_offset = Some(motion.tool_offset);
        let k = |at: &Coordinates, approach: Approach| {
            let with = Circumstances { approach, ..with };
            *at + setup.terms.correction(at, &with).unwrap()
        };
        let in_cycle = case.cycles.contains(&motion.block.as_str());
        let samples = motion.samples();
        let mut approach = with.approach;
        let mut before = samples[0];
        for (index, at) in samples.iter().enumerate() {
            let next = samples.get(index + 1).unwrap_or(at);
            approach = approach.after(&(*at - before));
            let onward = approach.after(&(*next - *at));
            before = *at;
            if motion.is_feed && !in_cycle {
                // Where an axis turns round the true place jumps.
                path.push(k(at, approach));
                if onward != approach {
                    path.push(k(at, onward));
                }
            }
            approach = onward;
        }
        if motion.is_feed && in_cycle {
            cycle_ends.push(k(samples.last().unwrap(), approach));
        }
        with.approach = approach;
    }
    (path, cycle_ends)
}

fn written_path(case: &Case, motions: &[Motion]) -> (Vec<Coordinates>, Vec<Coordinates>) {
    let (mut path, mut cycle_ends) = (Vec::new(), Vec::new());
    for motion in motions.iter().filter(|motion| motion.is_feed) {
        let samples = motion.samples();
        if case.cycles.contains(&motion.block.as_str()) {
            cycle_ends.extend(samples.last());
        } else {
            path.extend(samples);
        }
    }
    (path, cycle_ends)
}

/// Largest distance of the places of one path from the lines of the other, both gone along in order.
fn farthest(places: &[Coordinates], path: &[Coordinates]) -> (f64, Coordinates) {
    let mut near = 0;
    let mut worst = (0.0, Coordinates::ZERO);
    for place in places {
        let window = near..(near + 300).min(path.len() - 1);
        let (index, distance) = window
            .map(|index| (index, to_segment(place, &path[index], &path[index + 1])))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap();
        near = index.saturating_sub(3);
        if distance > worst.0 {
            worst = (distance, *place);
        }
    }
    worst
}

fn to_segment(place: &Coordinates, from: &Coordinates, to: &Coordinates) -> f64 {
    let (way, off) = (*to - *from, *place - *from);
    let dot = |a: &Coordinates, b: &Coordinates| a.iter().map(|(axis, v)| v * b[axis]).sum::<f64>();
    let squared = dot(&way, &way);
    let along = if squared > 0.0 {
        (dot(&off, &way) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (off - way * along).length_mm()
}

fn check(case: &Case) {
    if !linuxcnc::is_installed() {
        eprintln!("rs274 is not installed: nothing is compared");
        return;
    }
    let original = case.control.run(case.program.as_bytes());
    let corrected = corrected(case).unwrap();
    let text = String::from_utf8_lossy(&corrected).into_owned();
    let written = case.control.run(&corrected);
    let (true_path, true_ends) = true_path(case, &original);
    let (written_path, written_ends) = written_path(case, &written);
    assert!(true_path.len() > 40, "the program moves");
    let tolerance = Setup::read(case.setup, &case.files).unwrap().tolerance.mm;
    let (off, at) = farthest(&true_path, &written_path);
    assert!(
        off <= tolerance + ROUNDING_MM,
        "{off} mm at {at:?} is not reached:\n{text}"
    );
    let (off, at) = farthest(&written_path, &true_path);
    assert!(
        off <= tolerance + ROUNDING_MM,
        "{off} mm at {at:?} is too much:\n{text}"
    );
    assert_eq!(true_ends.len(), written_ends.len(), "{text}");
    for (truly, written) in true_ends.iter().zip(&written_ends) {
        assert!(
            (*truly - *written).length_mm() < ROUNDING_MM,
            "{truly:?} {written:?}\n{text}"
        );
    }
    // Were nothing corrected, the test would have seen it.
    let uncorrected: Vec<_> = original
        .iter()
        .filter(|m| m.is_feed)
        .flat_map(Motion::samples)
        .collect();
    assert!(farthest(&true_path, &uncorrected).0 > 5.0 * tolerance);
}

fn example(name: &str) -> Result<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/examples/correct");
    std::fs::read_to_string(folder.join(name)).map_err(|error| error.to_string())
}

#[test]
fn the_example_of_the_docs() {
    check(&Case {
        setup: include_str!("../../docs/examples/correct/setup.toml"),
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
    if !linuxcnc::is_installed() {
        return;
    }
    // Against a hand value: K = 0.1 mm in X alone moves centre and end of a full circle by that.
    let setup = "[control]\nstart = { X = 0.0, Y = 0.0, Z = 0.0 }\n\
                 [control.work_offsets]\norigins.G54 = { X = 0.0, Y = 0.0, Z = 0.0 }\n\
                 [[terms.affine]]\nname = \"x\"\nconstant_mm = { X = 0.1 }\n";
    let setup = Setup::read(setup, &|name| Err(name.to_owned())).unwrap();
    let dialect = Dialect::named("linuxcnc-mill").unwrap();
    let mut corrector =
        Corrector::new(dialect, &setup.control, setup.terms, setup.tolerance).unwrap();
    let program = "G21 G90 G17 G94 G54\nF100\nG1 X10 Y0 Z0\nG2 I-10\nM2\n";
    let mut out = Vec::new();
    corrector::correct(program.as_bytes(), &mut out, &mut corrector).unwrap();
    let control = Control {
        origin_mm: [0.0; 3],
        tools: "",
        start: Coordinates::ZERO,
    };
    let motions = control.run(&out);
    let circle = motions.last().unwrap().samples();
    for place in circle {
        let radius = (place[Axis::X] - 0.1).hypot(place[Axis::Y]);
        assert!((radius - 10.0).abs() < 2e-4, "{place:?}");
    }
}

const MILL: &str = r#"
dialect = "linuxcnc-mill"
tolerance_mm = 0.002
screw_map = "program"
[control]
start = { X = 0.0, Y = 0.0, Z = 0.0 }
tool = 0
tool_offset = 0
radius_tolerance_mm = 0.00127
[control.work_offsets]
active = "G54"
origins.G54 = { X = 5.0, Y = -7.0, Z = 11.0 }
[[terms.screw]]
axis = "X"
points = [
  { position_mm = -400, forward_um = 40, backward_um = 52 },
  { position_mm = -20, forward_um = -15, backward_um = -9 },
  { position_mm = 30, forward_um = 15, backward_um = 25 },
  { position_mm = 400, forward_um = -60, backward_um = -55 },
]
[[terms.affine]]
name = "lean and twist"
constant_mm = { X = 0.013, Y = -0.021, Z = 0.034 }
coefficient = [
  { corrects = "Y", by = "X", mm_per_mm = 3e-4 },
  { corrects = "Z", by = "X", over = "Y", places_mm = [-400, 400], mm_per_mm = [-6e-4, 6e-4] },
  { corrects = "X", by = "Z", mm_per_mm = -2e-4 },
]
"#;

/// What a mover of tools refuses with good reason in a program drawn at random.
fn is_understood(refusal: &str) -> bool {
    ["radius", "arc"].iter().any(|word| refusal.contains(word))
}

proptest::proptest! {
    #![proptest_config(random_programs::cases(12))]

    #[test]
    fn programs_drawn_at_random(draws in random_programs::draws()) {
        if !linuxcnc::is_installed() {
            return Ok(());
        }
        let case = Case {
            setup: MILL,
            files: |name| Err(name.to_owned()),
            program: random_programs::program(&draws),
            control: Control {
                origin_mm: [5.0, -7.0, 11.0],
                tools: "",
                start: Coordinates::ZERO,
            },
            cycles: &[],
        };
        match corrected(&case) {
            Ok(_) => check(&case),
            Err(refusal) => proptest::prop_assert!(is_understood(&refusal), "{refusal}\n{}", case.program),
        }
    }
}
