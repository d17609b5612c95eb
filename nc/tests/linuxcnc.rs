//! LinuxCNC's own programs and its own interpreter, where it is installed; said aloud where it is not.

#[path = "support/polynomial.rs"]
mod polynomial;
#[path = "reader/files.rs"]
mod reader_files;

use std::collections::BTreeMap;
use std::fs;
use std::io::BufReader;
use std::path::Path;
use std::process::Command;

use leadscrew_nc::coordinates::Axis;
use leadscrew_nc::corrector::{CorrectError, Corrector, correct};
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::machine_state::{MachineState, Tool};
use leadscrew_nc::path::Tolerance;
use leadscrew_nc::terms::{Circumstances, Terms};

use polynomial::Polynomial;

const TOLERANCE: Tolerance = Tolerance {
    mm: 0.003,
    degrees: 0.003,
};

fn polynomial(corrects: Axis, over: Axis, k0: f64, k1: f64, k2: f64) -> Polynomial {
    Polynomial {
        corrects,
        over,
        k0,
        k1,
        k2,
    }
}

/// G54 at 10, 20, 30; tool 1 of 50 mm; the axes at the machine's origin.
fn state() -> MachineState {
    let all = |value: f64| {
        Axis::ALL
            .into_iter()
            .map(|axis| (axis, value))
            .collect::<BTreeMap<_, _>>()
    };
    let mut state = MachineState {
        start: all(0.0),
        block_delete: Some(false),
        ..MachineState::default()
    };
    let mut origin = all(0.0);
    origin.extend([(Axis::X, 10.0), (Axis::Y, 20.0), (Axis::Z, 30.0)]);
    state.work_offsets.origins.insert("G54".into(), origin);
    let tool = Tool {
        offset: [(Axis::Z, 50.0)].into_iter().collect(),
        radius_mm: Some(2.0),
    };
    state.tools.insert(1, tool);
    state
}

fn run(dialect: &str, terms: Terms, program: &[u8]) -> Result<Vec<u8>, CorrectError> {
    let dialect = Dialect::named(dialect).unwrap();
    let mut corrector = Corrector::new(dialect, &state(), terms, TOLERANCE).unwrap();
    let mut out = Vec::new();
    correct(BufReader::new(program), &mut out, &mut corrector)?;
    Ok(out)
}

#[test]
fn identity_gives_identical_bytes() {
    for (path, program) in reader_files::all() {
        let out = run("linuxcnc-mill", Terms::none(), &program).unwrap();
        assert_eq!(out, program, "{}", path.display());
    }
}

/// With K = 0 everything is read, followed and written back; what cannot be followed is refused, and all before it is the same.
#[test]
fn a_correction_by_nothing_gives_identical_bytes_as_far_as_it_goes() {
    let (mut whole, mut bytes, mut refused) = (0, 0, BTreeMap::<String, u32>::new());
    let files = reader_files::all();
    for (path, program) in &files {
        for dialect in ["linuxcnc-mill", "linuxcnc-lathe"] {
            let zero = Terms::none().with(polynomial(Axis::X, Axis::X, 0.0, 0.0, 0.0));
            let dialect = Dialect::named(dialect).unwrap();
            let mut corrector = Corrector::new(dialect, &state(), zero, TOLERANCE).unwrap();
            let mut out = Vec::new();
            match correct(BufReader::new(&program[..]), &mut out, &mut corrector) {
                Ok(_) => {
                    whole += 1;
                    assert_eq!(out, *program, "{}", path.display());
                }
                Err(CorrectError::Refused(refusal)) => {
                    assert_eq!(out, program[..out.len()], "{}", path.display());
                    *refused.entry(refusal.reason.to_string()).or_default() += 1;
                }
                Err(error) => panic!("{}: {error}", path.display()),
            }
            bytes += out.len();
        }
    }
    println!(
        "{} programs, {whole} of {} runs whole, {bytes} bytes; refused: {refused:#?}",
        files.len(),
        2 * files.len()
    );
    assert!(whole > 0);
}

/// What rs274 says of a movement: its end, and its kind.
#[derive(Debug)]
struct Canon {
    kind: String,
    end: [f64; 3],
    /// mm of the unit it is printed in, in four decimals.
    unit: f64,
}

/// Runs a program through LinuxCNC's interpreter; none where it is not installed.
fn rs274(program: &str) -> Option<Vec<Canon>> {
    if !Path::new("/usr/bin/rs274").exists() {
        eprintln!(
            "SKIPPED: no /usr/bin/rs274: install linuxcnc-uspace to compare with its interpreter"
        );
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path
    };
    // Alone, without a machine's settings, it keeps tables in inches.
    let inches = |mm: f64| mm / 25.4;
    let tools = file(
        "tool.tbl",
        &format!("T1 P1 Z{:.12} D{:.12}\n", inches(50.0), inches(4.0)),
    );
    let mut parameters = String::new();
    let numbers = (5161..=5169)
        .chain(5181..=5189)
        .chain(5210..=5219)
        .chain(5220..=5230);
    let others = (0..8).flat_map(|system| 5241 + 20 * system..=5250 + 20 * system);
    for number in numbers.chain(others) {
        let value = match number {
            5220 => 1.0,
            5221 => inches(10.0),
            5222 => inches(20.0),
            5223 => inches(30.0),
            _ => 0.0,
        };
        parameters += &format!("{number}\t{value:.12}\n");
    }
    let parameters = file("rs274.var", &parameters);
    let program = file("program.ngc", program);
    // It keeps the tool table in a file at home, which others that run at the same time would share.
    let output = Command::new("/usr/bin/rs274")
        .env("HOME", folder.path())
        .current_dir(folder.path())
        .args(["-g", "-t"])
        .arg(&tools)
        .arg("-v")
        .arg(&parameters)
        .arg(&program)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        text.contains("PROGRAM_END"),
        "{text}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some(machine_places(&text))
}

/// Movements of canonical commands, in machine coordinates: they come without the offsets, which commands of their own set.
fn machine_places(text: &str) -> Vec<Canon> {
    let mut offset = [0.0; 3];
    let (mut work, mut shift, mut tool) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    let mut plane = [0, 1, 2];
    let mut unit = 1.0;
    let mut all: Vec<Canon> = Vec::new();
    for line in text.lines() {
        let Some((head, rest)) = line.split_once('(') else {
            continue;
        };
        let Some(kind) = head.split_whitespace().last() else {
            continue;
        };
        let numbers: Vec<f64> = rest
            .trim_end_matches(')')
            .split([',', ' '])
            .filter_map(|number| number.trim().parse::<f64>().ok())
            .collect();
        let three = |from: usize| [0, 1, 2].map(|axis| numbers[from + axis] * unit);
        match kind {
            "USE_LENGTH_UNITS" => unit = if rest.contains("INCHES") { 25.4 } else { 1.0 },
            "SET_G5X_OFFSET" => work = three(1),
            "SET_G92_OFFSET" => shift = three(0),
            "USE_TOOL_LENGTH_OFFSET" => tool = three(0),
            "SELECT_PLANE" => {
                plane = if rest.contains("XZ") {
                    [2, 0, 1]
                } else {
                    [0, 1, 2]
                }
            }
            "STRAIGHT_TRAVERSE" | "STRAIGHT_FEED" => {
                let end = three(0);
                all.push(Canon {
                    kind: kind.into(),
                    end: std::array::from_fn(|axis| end[axis] + offset[axis]),
                    unit,
                });
            }
            "ARC_FEED" => {
                let mut end = [0.0; 3];
                for (axis, at) in plane.into_iter().zip([0, 1, 5]) {
                    end[axis] = numbers[at] * unit + offset[axis];
                }
                all.push(Canon {
                    kind: kind.into(),
                    end,
                    unit,
                });
            }
            _ => {}
        }
        offset = std::array::from_fn(|axis| work[axis] + shift[axis] + tool[axis]);
    }
    all
}

fn compare(dialect: &str, program: &str, terms: impl Fn() -> Terms) {
    let corrected =
        run(dialect, terms(), program.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    let corrected = String::from_utf8(corrected).unwrap();
    let (Some(meant), Some(real)) = (rs274(program), rs274(&corrected)) else {
        return;
    };
    assert!(real.len() >= meant.len() && meant.len() > 5, "{corrected}");
    let terms = terms();
    let mut reals = real.iter();
    for movement in &meant {
        let [x, y, z] = movement.end;
        let at = leadscrew_nc::coordinates::Coordinates::xyz(x, y, z);
        let k = terms.correction(&at, &Circumstances::default()).unwrap();
        let wanted = [x + k[Axis::X], y + k[Axis::Y], z + k[Axis::Z]];
        // Pieces come between; half a step of the words, and of what is printed.
        let near = |real: &&Canon| {
            real.end
                .iter()
                .zip(wanted)
                .all(|(got, wanted)| (got - wanted).abs() < 1.1e-4 * real.unit)
        };
        let found = reals.find(near);
        let found = found.unwrap_or_else(|| {
            panic!("{movement:?} should end at {wanted:?}: {real:#?}\n{corrected}")
        });
        assert_eq!(found.kind, movement.kind, "{corrected}");
    }
    assert_eq!(reals.count(), 0, "movements behind the last: {corrected}");
}

#[test]
fn the_interpreter_of_linuxcnc_moves_to_target_plus_k_milling() {
    let program = "G21 G90 G54 G17\nT1 M6\nG43 H1\nG0 X0 Y0 Z20\nG1 Z-1 F100\nX80\nG91 Y30\nX-12.5 Z0.5\nG90\n\
                   G2 X40 Y40 I-13.75 J5\nG3 X50 Y50 R10\nG3 I-10 Z-2\nG92 X0 Y0\nG1 X10 Y10\nG92.1\nX5 Y5\n\
                   G20 X1 Y1.5\nG91 X.1\nG90 G21\nG53 G1 X60 Y60 Z70\nG0 X0 Y0 Z30\nG49\nG0 X0\nM2\n";
    compare(
        "linuxcnc-mill",
        &program.replace("G2 X40 Y40 I-13.75 J5\n", "G2 X40 Y40 R40\n"),
        || {
            Terms::none()
                .with(polynomial(Axis::X, Axis::Y, 0.01, 2e-4, 0.0))
                .with(polynomial(Axis::Y, Axis::X, 0.0, -1e-4, 1e-5))
                .with(polynomial(Axis::Z, Axis::X, -0.02, 3e-4, 0.0))
        },
    );
}

/// Only the bottoms of the holes are places that the program states.
#[test]
fn the_interpreter_of_linuxcnc_drills_to_the_bottom_plus_k() {
    let program = "G21 G90 G54 G17\nG0 X0 Y0 Z30\nG99 G81 X10 Y10 Z-5 R2 F50\nX70\nG98 G83 Y40 Z-8 R1 Q20\nX10\nG80\nM2\n";
    let terms = || {
        Terms::none()
            .with(polynomial(Axis::X, Axis::Y, 0.01, 2e-4, 0.0))
            .with(polynomial(Axis::Z, Axis::X, -0.02, 3e-4, 0.0))
    };
    let corrected = run("linuxcnc-mill", terms(), program.as_bytes()).unwrap();
    let (Some(meant), Some(real)) = (
        rs274(program),
        rs274(&String::from_utf8(corrected).unwrap()),
    ) else {
        return;
    };
    let bottoms = |all: Vec<Canon>| {
        all.into_iter()
            .filter(|one| one.kind == "STRAIGHT_FEED")
            .map(|one| one.end)
    };
    let (meant, real): (Vec<_>, Vec<_>) = (bottoms(meant).collect(), bottoms(real).collect());
    assert_eq!((meant.len(), real.len()), (4, 4));
    for ([x, y, z], got) in meant.into_iter().zip(real) {
        let at = leadscrew_nc::coordinates::Coordinates::xyz(x, y, z);
        let k = terms().correction(&at, &Circumstances::default()).unwrap();
        let wanted = [x + k[Axis::X], y + k[Axis::Y], z + k[Axis::Z]];
        assert!(
            got.iter()
                .zip(wanted)
                .all(|(got, wanted)| (got - wanted).abs() < 1.1e-4),
            "{got:?} {wanted:?}"
        );
    }
}

#[test]
fn the_interpreter_of_linuxcnc_moves_to_target_plus_k_turning() {
    let program = "G21 G90 G54 G18 G7\nT1 M6\nG43 H1\nG0 X60 Z5\nG1 X40 Z0 F100\nZ-20\nG2 X50 Z-25 I5 K0\nG3 X60 Z-30 R5\n\
                   G1 G91 X-2 Z3\nG90 G8 X20\nG7 X30 Z-60\nG92 X30\nG1 X28\nG92.1\nG0 X60 Z5\nM2\n";
    compare(
        "linuxcnc-lathe",
        &program.replace("G8 X20\nG7 X30", "X20\nG8\nX18\nG7\nX30"),
        || {
            Terms::none()
                .with(polynomial(Axis::X, Axis::Z, 0.005, 1e-4, 2e-6))
                .with(polynomial(Axis::Z, Axis::X, 0.01, -2e-4, 0.0))
        },
    );
}
