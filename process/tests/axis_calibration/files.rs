//! Files of runs and tables, and what is wrong with them.

use leadscrew_process::axis_calibration::linuxcnc::CompType;
use leadscrew_process::axis_calibration::{Direction, ErrorPoint, ErrorTable, Runs};

const RUNS: &str = "# laser, 23 November\ntarget_mm, direction, run, reading_mm, temperature_c\n\n\
                    0.137, up, 1, 0.1391, 21.3\n0.137, backward, 1, 0.1370,\n# again\n10.9, -, 2, 10.8985, 21.5\n";

#[test]
fn runs_are_read_with_comments_blanks_and_missing_temperatures() {
    let runs = Runs::read(RUNS).unwrap();
    assert_eq!(runs.readings.len(), 3);
    let [one, two, three] = &runs.readings[..] else {
        panic!()
    };
    assert!((one.deviation_um - 2.1).abs() < 1e-9);
    assert_eq!(
        (one.direction, one.run, one.temperature_c),
        (Direction::Up, 1, Some(21.3))
    );
    assert_eq!((two.direction, two.temperature_c), (Direction::Down, None));
    assert!((three.deviation_um + 1.5).abs() < 1e-9);
    let again = Runs::read(&runs.to_csv()).unwrap();
    assert_eq!(again.readings.len(), 3);
    assert!((again.readings[2].deviation_um + 1.5).abs() < 1e-9);
    assert_eq!(again.readings[1].temperature_c, None);
}

#[test]
fn wrong_runs_are_refused_with_line_and_column() {
    let of = |from: &str, to: &str| {
        assert!(RUNS.contains(from), "{from}");
        Runs::read(&RUNS.replacen(from, to, 1))
            .unwrap_err()
            .to_string()
    };
    for (from, to, said) in [
        (
            "0.1391",
            "0.13.91",
            "4:15: reading_mm = \"0.13.91\": expected a number",
        ),
        ("0.1391", "nan", "4:15: reading_mm = nan is out of range"),
        (
            "0.1391",
            "11.1",
            "4:15: the reading is 10.963 mm off its target: allowed 10 mm",
        ),
        (
            "backward",
            "left",
            "5:8: direction \"left\": expected up or down",
        ),
        ("-, 2,", "-, 2.5,", "7:10: run 2.5: expected a whole number"),
        (
            "backward",
            "up",
            "5:12: target 0.137 mm, up, run 1 is there twice: number the runs",
        ),
        (
            "21.5",
            "215",
            "7:22: temperature_c = 215 is out of range: allowed -20 to 80",
        ),
        (
            "run,",
            "pass,",
            "2:23: column \"pass\" is not known: expected target_mm, direction, run, reading_mm",
        ),
        (
            "temperature_c\n",
            "run\n",
            "2:40: column \"run\" is there twice",
        ),
        (", 21.3", "", "4:1: 4 fields, and the header has 5 columns"),
        ("target_mm, ", "", "2:1: there is no column \"target_mm\""),
    ] {
        let error = of(from, to);
        assert!(error.starts_with(said), "{from} → {to}: {error}");
    }
    let neither = Runs::read("target_mm,direction,run\n").unwrap_err();
    assert!(
        neither
            .to_string()
            .starts_with("1:1: expected one of the columns reading_mm and deviation_um")
    );
    let commented = Runs::read("# of X\n# laser\ntarget_mm,direction,run\n").unwrap_err();
    assert!(commented.to_string().starts_with("3:1: expected one of"));
    let empty = Runs::read("").unwrap_err().to_string();
    assert!(
        empty.starts_with("1:1: the file is empty: expected the header target_mm,direction,run"),
        "{empty}"
    );
}

#[test]
fn wrong_tables_are_refused_with_line_and_column() {
    let text = "position_mm,forward_um,backward_um\n0,1,2\n10,3,4\n";
    assert_eq!(ErrorTable::read(text).unwrap().points.len(), 2);
    for (from, to, said) in [
        (
            "10,",
            "0,",
            "3:1: position_mm = 0 does not lie above the 0 before it",
        ),
        ("3,4", "3,x", "3:6: backward_um = \"x\": expected a number"),
        ("10,3,4\n", "", "3:1: 1 points: at least 2 are needed"),
        (
            "forward_um",
            "forward",
            "1:13: column \"forward\" is not known",
        ),
    ] {
        let error = ErrorTable::read(&text.replacen(from, to, 1))
            .unwrap_err()
            .to_string();
        assert!(error.starts_with(said), "{from} → {to}: {error}");
    }
    let long: String = (0..257).map(|at| format!("{at},0,0\n")).collect();
    let error =
        ErrorTable::read(&format!("position_mm,forward_um,backward_um\n{long}")).unwrap_err();
    assert!(
        error.to_string().starts_with("258:1: more than 256 points"),
        "{error}"
    );
}

fn table(points: &[(f64, [f64; 2])]) -> ErrorTable {
    let point = |(position_mm, error_um): &(f64, [f64; 2])| ErrorPoint {
        position_mm: *position_mm,
        error_um: *error_um,
    };
    ErrorTable {
        points: points.iter().map(point).collect(),
    }
}

#[test]
fn what_the_board_does_not_hold_is_refused() {
    let refused = |points: &[(f64, [f64; 2])], k: f64| table(points).to_screw(k).unwrap_err();
    let large = refused(&[(0.0, [0.0; 2]), (100.0, [0.0, 1200.0])], 1000.0);
    assert!(
        large.starts_with("point 1 at 100 mm: an error of 1200.0 d"),
        "{large}"
    );
    let steep = refused(&[(0.0, [0.0; 2]), (1.0, [150.0, 0.0])], 1000.0);
    assert!(steep.contains("slope") || steep.contains("0.15"), "{steep}");
    assert!(refused(&[(0.0, [0.0; 2]), (1.0, [0.0; 2])], 0.0).contains("no resolution"));
}

#[test]
fn linuxcnc_gets_places_or_trims() {
    let table = table(&[(0.0, [2.0, -1.0]), (100.25, [0.0, 30.5])]);
    assert_eq!(
        table.to_linuxcnc(CompType::Places),
        "0.000000000 0.002000000 -0.001000000\n100.250000000 100.250000000 100.280500000\n"
    );
    assert_eq!(
        table.to_linuxcnc(CompType::Trims),
        "0.000000000 -0.002000000 0.001000000\n100.250000000 0.000000000 -0.030500000\n"
    );
}
