//! Any text as a file that the process engineer's commands read. For the tests and for the fuzzer.
//!
//! The first byte chooses the kind of file by its remainder; the rest is the file. Files that need another beside them get the
//! parts and tables below.

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::corrector::Corrector;
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::machine_state::MachineState;
use leadscrew_nc::path::Tolerance;
use leadscrew_nc::setup::Setup;
use leadscrew_nc::source::Complaint;
use leadscrew_nc::terms::grid::Grid;
use leadscrew_nc::terms::screw::ScrewMap;
use leadscrew_nc::terms::{Approach, Circumstances, Direction, Terms};
use leadscrew_process::axis_calibration::{Calibration, ErrorTable, Expansion, Runs};
use leadscrew_process::deviations;
use leadscrew_process::metrology::Settings;
use leadscrew_process::metrology::part::{self, Part, evaluate, log, program, touches};
use leadscrew_process::plan::Catalogue;
use leadscrew_process::probing::delay::SpeedTouch;
use leadscrew_process::probing::run_out::TurnedTouch;
use leadscrew_process::probing::stylus::{self, Artefact};

const HOUSING: &str = include_str!("../metrology/data/housing.toml");
const SHAFT: &str = include_str!("../metrology/data/shaft.toml");

/// Reads a text, uses what it says, and gives what is wrong with it.
type Read = fn(&str) -> Result<(), Complaint>;

/// The kinds of files, by the byte that chooses them.
pub const KINDS: [(&str, Read); 15] = [
    ("dialect", dialect),
    ("setup", setup),
    ("grid", grid),
    ("screw map", screw_map),
    ("part", part),
    ("touches", touches_of_a_part),
    ("touches of a turned part", touches_of_a_shaft),
    ("log", log_of_a_part),
    ("runs", runs),
    ("error table", error_table),
    ("machine", machine),
    ("catalogue", catalogue),
    ("stylus", touches_of_a_stylus),
    ("trigger delay", trigger_delay),
    ("run-out", run_out),
];

/// Reads the file; what is refused is told at a place that is there, in words.
pub fn check(bytes: &[u8]) {
    let (choice, text) = bytes.split_first().unwrap_or((&0, &[]));
    // What is no UTF-8 is refused before a reader sees it.
    let Ok(text) = std::str::from_utf8(text) else {
        return;
    };
    let (kind, read) = KINDS[usize::from(*choice) % KINDS.len()];
    if let Err(complaint) = read(text) {
        is_told_well(kind, text, &complaint);
    }
}

fn is_told_well(kind: &str, text: &str, complaint: &Complaint) {
    let place = complaint.place;
    let lines: Vec<_> = text.split('\n').collect();
    assert!(
        (1..=lines.len()).contains(&place.line),
        "{kind}: {complaint}"
    );
    let columns = lines[place.line - 1].chars().count() + 1;
    assert!((1..=columns).contains(&place.column), "{kind}: {complaint}");
    assert!(complaint.message.len() > 8, "{kind}: {complaint}");
    let is_one_line = !complaint.message.contains('\n') || text.contains("\\n");
    assert!(is_one_line || text.contains('\n'), "{kind}: {complaint}");
}

fn dialect(text: &str) -> Result<(), Complaint> {
    let dialect = Dialect::from_toml(text)?;
    let tolerance = Tolerance {
        mm: 0.001,
        degrees: 0.001,
    };
    let state = MachineState::default();
    let program = b"N1 G0 X1 (a)\n";
    let mut corrector = Corrector::new(dialect, &state, Terms::none(), tolerance)
        .unwrap_or_else(|error| panic!("{error}"));
    let mut out = Vec::new();
    corrector
        .block(program, &mut out)
        .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(out, program);
    Ok(())
}

/// Some places within the tables, and out of them.
fn places() -> impl Iterator<Item = (Coordinates, Circumstances)> {
    [0.0, 12.5, -300.0, 1e5].into_iter().flat_map(|at| {
        [Direction::Up, Direction::Down].map(|direction| {
            let approach = Axis::ALL
                .into_iter()
                .fold(Approach::UNKNOWN, |all, axis| all.with(axis, direction));
            let place = Coordinates::xyz(at, -at, 0.5 * at).with(Axis::B, at);
            let with = Circumstances {
                tool: Some(1),
                tool_offset: Some(Coordinates::xyz(0.0, 0.0, 50.0)),
                approach,
            };
            (place, with)
        })
    })
}

/// K is finite wherever it is told.
fn are_finite(terms: &Terms) {
    for (place, with) in places() {
        if let Ok(k) = terms.correction(&place, &with) {
            assert!(k.iter().all(|(_, k)| k.is_finite()), "{k:?} at {place:?}");
        }
    }
    for axis in Axis::ALL {
        terms.breaks(axis, &mut |breaks| {
            assert!(breaks.iter().all(|place| place.is_finite()), "{breaks:?}");
        });
    }
}

fn setup(text: &str) -> Result<(), Complaint> {
    let files = |name: &str| match name {
        "volume.toml" => Ok(include_str!("../../../docs/examples/correct/volume.toml").to_owned()),
        "screw-x.csv" => Ok(include_str!("../../../docs/examples/correct/screw-x.csv").to_owned()),
        // A file that is wrong in itself.
        "itself" => Ok(text.to_owned()),
        _ => Err(format!("{name}: cannot be read")),
    };
    let setup = Setup::read(text, &files)?;
    are_finite(&setup.terms);
    if let Some(dialect) = setup.dialect {
        let made = Corrector::new(dialect, &setup.control, setup.terms, setup.tolerance);
        if let Err(error) = made {
            assert!(error.to_string().len() > 8);
        }
    }
    Ok(())
}

fn grid(text: &str) -> Result<(), Complaint> {
    let grid = Grid::read(text)?;
    let nodes: Vec<_> = grid.nodes().collect();
    let terms = Terms::none().with(grid);
    for (place, wanted) in nodes {
        let with = Circumstances {
            tool_offset: Some(Coordinates::ZERO),
            ..Circumstances::default()
        };
        if let Ok(k) = terms.correction(&place, &with) {
            assert!((k - wanted).length_mm() < 1e-6, "{k:?} {wanted:?}");
        }
    }
    are_finite(&terms);
    Ok(())
}

fn screw_map(text: &str) -> Result<(), Complaint> {
    let map = ScrewMap::read_csv("screw X", Axis::X, text)?;
    are_finite(&Terms::none().with(map));
    Ok(())
}

/// Its program is written and its log understood.
fn part(text: &str) -> Result<(), Complaint> {
    let part = part::read(text)?;
    let program = program::write(text, &part)?;
    assert!(program.is_ascii() || !text.is_ascii(), "{program}");
    Ok(())
}

fn evaluated(text: &str, part: &Part, touches: &part::Touches) {
    // Touches that determine nothing are told of at the feature.
    match evaluate::evaluate(text, part, touches, &Settings::default()) {
        Ok(report) => assert_eq!(report.features.len(), part.features.len()),
        Err(complaint) => is_told_well("evaluation", text, &complaint),
    }
}

fn read_touches(part_text: &str, text: &str) -> Result<(), Complaint> {
    let part = part::read(part_text)?;
    evaluated(part_text, &part, &touches::read(text, &part)?);
    Ok(())
}

fn touches_of_a_part(text: &str) -> Result<(), Complaint> {
    read_touches(HOUSING, text)
}

fn touches_of_a_shaft(text: &str) -> Result<(), Complaint> {
    read_touches(SHAFT, text)
}

fn log_of_a_part(text: &str) -> Result<(), Complaint> {
    let part = part::read(HOUSING)?;
    evaluated(HOUSING, &part, &log::read(text, &part)?);
    Ok(())
}

/// What is written of them is read again, and the figures are numbers.
fn runs(text: &str) -> Result<(), Complaint> {
    let runs = Runs::read(text)?;
    let again = Runs::read(&runs.to_csv())?;
    assert_eq!(again, runs);
    if let Ok(calibration) = Calibration::of(&runs, &Expansion::default(), false) {
        let table = ErrorTable::of(&calibration);
        if !(2..=256).contains(&table.points.len()) {
            return Ok(());
        }
        let again = ErrorTable::read(&table.to_csv());
        assert!(again.is_ok(), "{}{again:?}", table.to_csv());
    }
    Ok(())
}

fn error_table(text: &str) -> Result<(), Complaint> {
    let table = ErrorTable::read(text)?;
    let again = ErrorTable::read(&table.to_csv())?;
    assert_eq!(again.points.len(), table.points.len());
    if let Ok(stored) = table.to_stored(1000.0) {
        let again = ErrorTable::of_stored(&stored, 1000.0);
        assert!(again.is_ok(), "{again:?}");
    }
    Ok(())
}

fn machine(text: &str) -> Result<(), Complaint> {
    let machine = deviations::read(text)?.machine;
    let mut at = Coordinates::ZERO;
    for (axis, (low, high)) in machine.axes() {
        at[axis] = f64::midpoint(low, high);
    }
    if let Ok(point) = machine.point(&at) {
        let parts = format!("{point:?}");
        assert!(!parts.contains("NaN") && !parts.contains("inf"), "{parts}");
    }
    Ok(())
}

fn catalogue(text: &str) -> Result<(), Complaint> {
    let mut catalogue = Catalogue::built_in()?;
    catalogue.add(text)
}

fn touches_of_a_stylus(text: &str) -> Result<(), Complaint> {
    let places = stylus::read(text, Artefact::Sphere)?;
    assert!(places.iter().flatten().all(|number| number.is_finite()));
    Ok(())
}

fn trigger_delay(text: &str) -> Result<(), Complaint> {
    SpeedTouch::read(text).map(|_| ())
}

fn run_out(text: &str) -> Result<(), Complaint> {
    TurnedTouch::read(text).map(|_| ())
}
