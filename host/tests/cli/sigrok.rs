//! Against sigrok's own decoder of rotary encoders, where `sigrok-cli` is installed.

use std::path::Path;
use std::process::Command;

use crate::capture_files::sigrok_vcd;
use crate::scenes::{put_ramp, real_ramp, wander};
use crate::table::Table;
use crate::{Folder, text};

/// A count of sigrok's, and the sample up to which it held.
struct Held {
    count: i64,
    until: u64,
}

/// Counts by sigrok's decoder `graycode`; the last one, which nothing ends, is not told. `None` where
/// sigrok is not installed.
fn sigrok_counts(file: &Path) -> Option<Vec<Held>> {
    let run = |arguments: &[&str]| Command::new("sigrok-cli").args(arguments).output().ok();
    let shown = run(&["-P", "graycode", "--show"]);
    if !shown.is_some_and(|shown| text(&shown.stdout).contains("graycode")) {
        eprintln!("skipped: sigrok-cli with its decoder graycode is not installed");
        return None;
    }
    let file = file.to_str().expect("paths of tests are text");
    // Its exit code is not looked at: libsigrokdecode 0.5.3 crashes when it unloads Python 3.12, after
    // all is printed.
    let output = run(&[
        "-I",
        "vcd",
        "-i",
        file,
        "-P",
        "graycode:d0=0:d1=1",
        "-A",
        "graycode=count",
        "--protocol-decoder-samplenum",
    ])?;
    // Such as `3760-5318 graycode-1: 1`.
    let held = |line: &str| {
        let (span, count) = line.split_once(" graycode-1: ")?;
        let (_, until) = span.split_once('-')?;
        Some(Held {
            count: count.parse().ok()?,
            until: until.parse().ok()?,
        })
    };
    let printed = text(&output.stdout);
    let counts = printed
        .lines()
        .map(|line| held(line).unwrap_or_else(|| panic!("{line}")));
    Some(counts.collect())
}

/// Asserts the same edges, the same end and the same count at every tick.
#[track_caller]
fn assert_agrees(folder: &Folder, file: &Path) {
    let Some(theirs) = sigrok_counts(file) else {
        return;
    };
    let last = theirs.last().expect("some edges");
    let name = file.to_str().expect("paths of tests are text");
    let report = folder.json(&format!("replay {name} --tick-hz 2500 --csv ticks.csv"));
    assert_eq!(report["edges"], theirs.len());
    let final_count = report["final_count"].as_i64().expect("a count");
    assert_eq!((final_count - last.count).abs(), 1);

    let table = Table::read(&folder.path("ticks.csv"));
    for (tick, ours) in table.column("count_d").into_iter().enumerate() {
        // A sample a microsecond, a tick every 400.
        let now = theirs.iter().find(|held| held.until > 400 * tick as u64);
        assert_eq!(
            ours,
            now.map_or(final_count, |held| held.count) as f64,
            "tick {tick}"
        );
    }
}

#[test]
fn the_ramp_as_the_test_writes_it() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    assert_agrees(&folder, &folder.path("ramp.vcd"));
}

#[test]
fn the_ramp_of_the_sigrok_project() {
    if let Some(file) = real_ramp() {
        assert_agrees(&Folder::new(), &file);
    }
}

#[test]
fn reversals_and_illegal_transitions() {
    let folder = Folder::new();
    folder.write("wander.vcd", sigrok_vcd(&wander(), &["0", "1"]));
    assert_agrees(&folder, &folder.path("wander.vcd"));
    let report = folder.json("replay wander.vcd");
    assert_eq!(report["illegal"], 3900 / 97);
}
