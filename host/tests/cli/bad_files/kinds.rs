//! A good file of each kind, the command that reads it, and the slips that documents are tried with.

use std::fmt::Write as _;

use super::{Flaw, Kind};

pub(super) fn setup(rest: &str) -> String {
    format!(
        "dialect = \"linuxcnc-mill\"\n[control]\nstart = {{ X = 0.0, Y = 0.0, Z = 0.0 }}\n\
         [control.work_offsets]\norigins.G54 = {{ X = 0.0, Y = 0.0, Z = 0.0 }}\n{rest}"
    )
}

pub(super) const PROGRAM: &str = "G21 G90 G17 G94 G54\nG0 X10 Y20 (over)\nM2\n";
pub(super) const CORRECT: &str = "correct part.ngc --setup setup.toml";
const PART: &str = "[probe]\nsigma_mm = 0.001\nradius_mm = 3.0\n[program]\nsafe_axis = \"z\"\nsafe_mm = 60.0\n\
    approach_mm = 2.0\novertravel_mm = 1.5\nfeed_mm_per_min = 100.0\nlog = \"log.txt\"\n[[plane]]\nname = \"top\"\n\
    normal = \"+z\"\npoints_mm = [[10, 10, 0], [190, 10, 0], [10, 90, 0], [190, 90, 0]]\n";
const TOUCHES: &str = "feature,point,measured_x_mm,measured_y_mm,measured_z_mm\ntop,1,10,10,0.0125\n\
    top,2,190,10,0\ntop,3,10,90,0\ntop,4,190,90,0\n";
const LOG: &str =
    "10 10 3.0125 0 0 0 0 0 0\n190 10 3 0 0 0 0 0 0\n10 90 3 0 0 0 0 0 0\n190 90 3 0 0 0 0 0 0\n";
const MACHINE: &str = "name = \"table\"\norigin = \"made up\"\ndrive_errors = \"included\"\ntool_mm = [0.0, 0.0, 125.5]\n\
    [[tool]]\nname = \"slide\"\naxis = \"Z\"\nlinear = \"+z\"\nrange_mm = [0.0, 800.0]\nframe_mm = [0.0, 0.0, 0.0]\n";
const CATALOGUE: &str = "[[machine]]\nname = \"Own\"\n[[machine.axis]]\nname = \"X\"\nmax_feed_mm_per_min = 120000\n\
    overload_g = 10.5\nmax_jerk_m_s3 = 5000\ncounts_per_mm = 100000\n";
const GRID: &str = "name = \"volume\"\n[[over]]\naxis = \"X\"\nplaces_mm = [-100.0, 412.5]\n[[correct]]\naxis = \"X\"\n\
    values_mm = [0.0, 0.01]\n";
const ERRORS: &str = "position_mm,forward_um,backward_um\n0,0,1\n50.5,2,3\n100,3,4\n";

fn runs() -> String {
    let mut text = "target_mm,direction,run,deviation_um\n".to_owned();
    for run in 1..=5 {
        for (target, deviation) in [0.3, 61.7, 122.4, 188.9, 243.1].into_iter().zip(1..) {
            let number = if run == 1 && deviation == 1 {
                1.25
            } else {
                f64::from(deviation)
            };
            let _ = writeln!(
                text,
                "{target},up,{run},{number}\n{target},down,{run},{deviation}"
            );
        }
    }
    text
}

fn ring() -> String {
    let mut text = "x_mm,y_mm\n9.5625,0.015\n".to_owned();
    for touch in 1..12 {
        let (y, x) = (f64::from(touch) * std::f64::consts::TAU / 12.0).sin_cos();
        let _ = writeln!(text, "{:.4},{:.4}", 9.5 * x, 9.5 * y);
    }
    text
}

pub(super) fn tables() -> Vec<Kind> {
    let delay =
        "position_mm,velocity_mm_per_min\n15.00125,100\n15.001,100\n15.002,200\n15.002,200\n";
    let turned = "along,angle_deg,position_mm\nx,0,9.9825\nx,180,10.02\n";
    let screw = "screw_map = \"program\"\n".to_owned()
        + &setup("[[terms.screw]]\naxis = \"X\"\nfile = \"screw.csv\"\n");
    vec![
        Kind::new("runs.csv", "calibrate-axis runs.csv", runs(), "1.25"),
        Kind::new(
            "delay.csv",
            "calibrate-probe delay delay.csv",
            delay.to_owned(),
            "15.00125",
        ),
        Kind::new(
            "ring.csv",
            "calibrate-probe stylus ring.csv --ring 25",
            ring(),
            "9.5625",
        ),
        Kind::new(
            "turned.csv",
            "calibrate-probe run-out turned.csv",
            turned.to_owned(),
            "9.9825",
        ),
        Kind::new(
            "touches.csv",
            "measure part.toml --touches touches.csv",
            TOUCHES.to_owned(),
            "0.0125",
        )
        .beside("part.toml", PART),
        Kind::new("screw.csv", CORRECT, ERRORS.to_owned(), "50.5")
            .beside("setup.toml", screw)
            .beside("part.ngc", PROGRAM),
        Kind::new(
            "errors.csv",
            "--port sim screw-table write errors.csv",
            ERRORS.to_owned(),
            "50.5",
        ),
    ]
}

pub(super) fn documents() -> Vec<(Kind, &'static [Flaw])> {
    let affine = setup("[[terms.affine]]\nname = \"shift\"\nconstant_mm = { X = 0.0125 }\n");
    let plain = setup("");
    let of_file = |file: &str| plain.replace("linuxcnc-mill", file);
    let dialect = include_str!("../../../../nc/dialects/iso-mill.toml").to_owned();
    let grid = setup("[[terms.grid]]\nfile = \"grid.toml\"\n");
    vec![
        (
            Kind::new("setup.toml", CORRECT, affine, "0.0125").beside("part.ngc", PROGRAM),
            &[
                (
                    "constant_mm",
                    "constant_m",
                    &[
                        "setup.toml:8:1: unknown field",
                        "did you mean `constant_mm`?",
                    ],
                ),
                (
                    "name = \"shift\"",
                    "name = \"a\"\nname = \"b\"",
                    &["setup.toml:8:1: the key `name` is there twice"],
                ),
                (
                    "0.0125",
                    "0,0125",
                    &["setup.toml:8:", "decimal point: 0.0125"],
                ),
                (
                    "0.0125",
                    "nan",
                    &["setup.toml:8:21:", "allowed are -1000 to 1000 mm"],
                ),
                (
                    "0.0125",
                    "1e9",
                    &["setup.toml:8:21:", "allowed are -1000 to 1000 mm"],
                ),
                (
                    "0.0125",
                    "\"much\"",
                    &["setup.toml:8:21:", "expected a number"],
                ),
                (
                    "\"shift\"",
                    "\"shift\";",
                    &["setup.toml:7:15:", "expected newline, `#`: found `;`"],
                ),
            ],
        ),
        (
            Kind::new("dialect.toml", CORRECT, dialect, "increment_inch")
                .beside("setup.toml", of_file("dialect.toml"))
                .beside("part.ngc", PROGRAM),
            &[(
                "increment_inch",
                "increment_inches",
                &["unknown field", "did you mean `increment_inch`?"],
            )],
        ),
        (
            Kind::new("grid.toml", CORRECT, GRID.to_owned(), "412.5")
                .beside("setup.toml", grid)
                .beside("part.ngc", PROGRAM),
            &[
                (
                    "places_mm",
                    "place_mm",
                    &[
                        "setup.toml:7:8: grid.toml:4:1: unknown field",
                        "did you mean `places_mm`?",
                    ],
                ),
                ("412.5", "nan", &["grid.toml:"]),
                ("412.5", "-412.5", &["grid.toml:", "must rise"]),
                (
                    "name = \"volume\"",
                    "name = 1,5",
                    &["grid.toml:1:9:", "decimal point: 1.5"],
                ),
            ],
        ),
        (
            Kind::new(
                "part.toml",
                "measure part.toml --touches touches.csv",
                PART.to_owned(),
                "0.001",
            )
            .beside("touches.csv", TOUCHES),
            &[
                (
                    "radius_mm",
                    "radius",
                    &["part.toml:3:1: unknown field", "did you mean `radius_mm`?"],
                ),
                (
                    "0.001",
                    "0,001",
                    &["part.toml:2:13:", "decimal point: 0.001"],
                ),
                ("0.001", "nan", &["part.toml:2:12:"]),
                ("0.001", "-1", &["part.toml:2:12:"]),
                (
                    "name = \"top\"\n",
                    "",
                    &["part.toml:11:", "missing field `name`"],
                ),
            ],
        ),
        (
            Kind::new(
                "machine.toml",
                "deviations machine.toml --map --steps 2",
                MACHINE.to_owned(),
                "125.5",
            ),
            &[
                (
                    "frame_mm",
                    "frame",
                    &[
                        "machine.toml:10:1: unknown field",
                        "did you mean `frame_mm`?",
                    ],
                ),
                ("125.5", "nan", &["machine.toml:4:11:"]),
                ("125.5", "1e9", &["machine.toml:4:11:", "100000"]),
                (
                    "\"included\"",
                    "\"include\"",
                    &["machine.toml:3:16: unknown variant", "included"],
                ),
            ],
        ),
        (
            Kind::new(
                "own.toml",
                "plan --catalogue own.toml",
                CATALOGUE.to_owned(),
                "10.5",
            ),
            &[
                (
                    "overload_g",
                    "overload",
                    &["own.toml:6:1: unknown field", "did you mean `overload_g`?"],
                ),
                ("10.5", "10,5", &["own.toml:6:16:", "decimal point: 10.5"]),
                ("10.5", "nan", &["own.toml:6:14:"]),
                ("10.5", "-1", &["own.toml:6:14:"]),
            ],
        ),
    ]
}

pub(super) fn log() -> Kind {
    Kind::new(
        "log.txt",
        "measure part.toml --log log.txt",
        LOG.to_owned(),
        "3.0125",
    )
    .beside("part.toml", PART)
}

/// Everything that is read as text.
pub(super) fn texts() -> Vec<Kind> {
    let documents = documents().into_iter().map(|(kind, _)| kind);
    tables()
        .into_iter()
        .chain(documents)
        .chain([log()])
        .collect()
}
