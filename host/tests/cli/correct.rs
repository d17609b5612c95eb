//! `leadscrew correct`: files, streams, reports and refusals; what it writes is tested in `nc`.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::Stdio;

use crate::{Folder, assert_clear, assert_says, keys, number, text};

const SETUP: &str = "dialect = \"linuxcnc-mill\"\n\
    [control]\nstart = { X = 0.0, Y = 0.0, Z = 0.0 }\n\
    [control.work_offsets]\norigins.G54 = { X = 0.0, Y = 0.0, Z = 0.0 }\n\
    [[terms.affine]]\nname = \"shift\"\nconstant_mm = { X = 0.01 }\n\
    coefficient = [{ corrects = \"Y\", by = \"X\", mm_per_mm = 1e-4 }]\n";

const PROGRAM: &str = "G21 G90 G17 G94 G54\nG0 X10 Y20 (over the hole)\nG1 X20 F100\nG4 P1\nM2\n";
const CORRECTED: &str =
    "G21 G90 G17 G94 G54\nG0 X10.01 Y20.001 (over the hole)\nG1 X20.01 Y20.002 F100\nG4 P1\nM2\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("setup.toml", SETUP);
    folder.write("part.ngc", PROGRAM);
    folder
}

#[test]
fn a_program_is_corrected_into_a_file_or_onto_standard_output() {
    let folder = folder();
    assert_eq!(
        folder.printed("correct part.ngc --setup setup.toml"),
        CORRECTED
    );
    assert_eq!(
        folder.printed("correct part.ngc --setup setup.toml -o out.ngc"),
        ""
    );
    assert_eq!(folder.read("out.ngc"), CORRECTED);
}

#[test]
fn the_identity_gives_the_same_bytes() {
    let folder = folder();
    let odd = "%\r\ng01x1.y-.5(a)\r\n\r\n;\u{e9}\nM2";
    folder.write("odd.ngc", odd);
    let printed = folder.printed("correct odd.ngc --setup setup.toml --identity");
    assert_eq!(printed, odd);
}

#[test]
fn the_report_counts_and_names_the_largest_corrections() {
    let folder = folder();
    let report = folder.json("correct part.ngc --setup setup.toml -o out.ngc");
    assert_eq!(report["schema"], "leadscrew/correct/1");
    assert_eq!(
        keys(&report),
        [
            "blocks",
            "blocks_added",
            "blocks_changed",
            "bytes_read",
            "bytes_written",
            "megabytes_per_s",
            "memory_growth_kb",
            "schema",
            "seconds",
            "terms"
        ]
    );
    assert_eq!(number(&report, "/blocks"), 5.0);
    assert_eq!(number(&report, "/blocks_changed"), 2.0);
    assert_eq!(number(&report, "/bytes_written"), CORRECTED.len() as f64);
    assert_eq!(report["terms"][0]["name"], "shift");
    assert_eq!(report["terms"][0]["largest"][0]["axis"], "X");
    assert!((number(&report, "/terms/0/largest/1/value") - 0.002).abs() < 1e-12);
    let printed = folder.printed("correct part.ngc --setup setup.toml --check --report");
    assert_says(
        &printed,
        &[
            "5 blocks read, 2 changed, 0 added",
            "largest K of \"shift\": X 0.0100 mm Y 0.0020 mm",
            "MB/s",
        ],
    );
}

#[test]
fn a_refused_block_leaves_the_file_as_it_was_and_says_where_and_what_to_do() {
    let folder = folder();
    folder.write("bad.ngc", PROGRAM.replace("G4 P1", "G1 X[#1+2]"));
    folder.write("out.ngc", "before");
    let error = folder.refused(1, "correct bad.ngc --setup setup.toml -o out.ngc");
    assert_says(&error, &["bad.ngc:4:4: "]);
    assert_eq!(folder.read("out.ngc"), "before");
    let error = folder.refused(1, "correct bad.ngc --setup setup.toml --check");
    assert_says(&error, &["bad.ngc:4:4: "]);
    // Onto standard output what came before is out.
    let output = folder.run("correct bad.ngc --setup setup.toml");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(text(&output.stdout), CORRECTED.split("G4").next().unwrap());
    assert_clear(&text(&output.stderr));
}

#[test]
fn a_stream_gives_each_block_before_it_reads_the_next() {
    let folder = folder();
    let mut command = folder.command(["correct", "-", "--setup", "setup.toml"]);
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut to = child.stdin.take().unwrap();
    let mut from = BufReader::new(child.stdout.take().unwrap());
    for (block, corrected) in PROGRAM.lines().zip(CORRECTED.lines()) {
        writeln!(to, "{block}").unwrap();
        to.flush().unwrap();
        let mut answer = String::new();
        // Were the block kept back, this would wait for ever.
        from.read_line(&mut answer).unwrap();
        assert_eq!(answer.trim_end(), corrected);
    }
    drop(to);
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
fn mistakes_of_the_command_line_and_the_setup_are_told() {
    let folder = folder();
    folder.write(
        "no-dialect.toml",
        SETUP.replace("dialect = \"linuxcnc-mill\"", ""),
    );
    folder.write("typo.toml", SETUP.replace("constant_mm", "constant"));
    folder.write("offset.toml", SETUP.replace("G54", "G12"));
    folder.write(
        "axis.toml",
        SETUP.replace("corrects = \"Y\"", "corrects = \"U\""),
    );
    for (code, arguments, parts) in [
        (
            2,
            "correct part.ngc --setup setup.toml --json",
            &["--json", "--out FILE"][..],
        ),
        (
            2,
            "correct part.ngc --setup setup.toml -o part.ngc",
            &["is the file that is read"],
        ),
        (
            2,
            "correct part.ngc --setup no-dialect.toml",
            &["names no dialect", "linuxcnc-lathe"],
        ),
        (
            2,
            "correct part.ngc --setup setup.toml --dialect fanuc",
            &["--dialect fanuc", "iso-mill"],
        ),
        (
            1,
            "correct part.ngc --setup typo.toml",
            &["typo.toml:8:1: unknown field `constant`"],
        ),
        (
            1,
            "correct part.ngc --setup offset.toml",
            &["offset.toml:5:15: control.work_offsets.origins.G12"],
        ),
        (
            1,
            "correct part.ngc --setup axis.toml --dialect iso-mill",
            &["axis.toml:6:1: term \"shift\" corrects U"],
        ),
        (
            1,
            "correct part.ngc --setup none.toml",
            &["none.toml: cannot be read"],
        ),
        (
            1,
            "correct none.ngc --setup setup.toml",
            &["none.ngc: cannot be read"],
        ),
    ] {
        assert_says(&folder.refused(code, arguments), parts);
    }
}

#[test]
fn the_example_of_the_docs_is_corrected() {
    let folder = Folder::new();
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/examples/correct");
    for name in ["setup.toml", "volume.toml", "screw-x.csv", "plate.ngc"] {
        folder.write(name, std::fs::read(examples.join(name)).unwrap());
    }
    insta::assert_snapshot!(folder.printed("correct plate.ngc --setup setup.toml"));
}
