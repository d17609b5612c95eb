//! `leadscrew replay --map`: an encoder's map, tied by the index.

use leadscrew::encoder_map::encode::{MapContent, encode};
use leadscrew::encoder_map::format::image_len;
use leadscrew::encoder_map::{Form, Residual};
use leadscrew_host::recording::{Change, Recording};

use crate::capture_files::sigrok_vcd;
use crate::scenes::levels_at;
use crate::table::Table;
use crate::{Folder, assert_says, keys, number};

const EDGES: i64 = 400;
/// Time of a discrete, µs: 2 d a tick of 1 ms.
const PER_D_US: f64 = 500.0;
const ALONE: &str = "--estimator polynomial";

/// Where an edge lies above its place, d: phases, lines and a wave a revolution, each of them large.
fn error(edge: i64) -> f64 {
    let edge = edge.rem_euclid(EDGES);
    let phase = [0.12, -0.08, 0.05, -0.09][(edge % 4) as usize];
    let line = ((edge / 4 * 37 % 101) as f64 / 100.0 - 0.5) * 0.3;
    let turn = (edge as f64 / EDGES as f64 * std::f64::consts::TAU).sin();
    phase + line + 0.5 * turn
}

/// A steady feed of some revolutions with an index pulse of 2 d each, whose front comes with edge 0. From
/// `slip_from` on the index comes so many edges late.
fn feed(first: i64, slip_from: i64, slip: i64) -> Recording {
    let change = |edge: i64| {
        let turned = edge - if edge > slip_from { slip } else { 0 };
        let place = (edge - first) as f64 + error(edge);
        let mut levels = levels_at(edge);
        levels.z = turned.rem_euclid(EDGES) < 2;
        Change {
            time: (place * PER_D_US).round() as u64,
            levels,
        }
    };
    Recording {
        clock_hz: 1_000_000,
        duration: 900_000,
        initial: levels_at(first),
        changes: (first + 1..first + 1790).map(change).collect(),
    }
}

/// The image of the encoder's map.
fn map(form: Form) -> Vec<u8> {
    let bits = |value: f64| (value * 65_536.0).round() as i32;
    let phases = [0, 1, 2, 3].map(|phase: i64| {
        let lines = (0..EDGES / 4).map(|line| error(4 * line + phase));
        bits(lines.sum::<f64>() / (EDGES / 4) as f64)
    });
    let content = MapContent {
        edges: EDGES as u32,
        error: &|edge| bits(error(i64::from(edge))),
        phases: [phases; 2],
        fronts: [Some(0), Some(0)],
        residual: Residual::default(),
    };
    let mut image = vec![0; image_len(EDGES as u32, form)];
    encode(&content, form, &mut image).expect("a map");
    image
}

fn folder() -> Folder {
    let folder = Folder::new();
    let vcd = |recording: &Recording| sigrok_vcd(recording, &["A", "B", "Z"]);
    folder.write("feed.vcd", vcd(&feed(-150, i64::MAX, 0)));
    folder.write("slips.vcd", vcd(&feed(-150, 600, 8)));
    folder.write("full.map", map(Form::Full));
    folder.write("phases.map", map(Form::Phases));
    folder
}

/// Rms of the acceleration that the polynomial sees in a motion without any, d/tick², from tick 400 on.
fn noise(folder: &Folder, arguments: &str) -> f64 {
    folder.printed(&format!("replay feed.vcd {ALONE} {arguments} --csv x.csv"));
    let rows = Table::read(&folder.path("x.csv")).column("acceleration_d_per_tick2");
    let squares = rows[400..850].iter().map(|value| value * value);
    (squares.sum::<f64>() / 450.0).sqrt()
}

#[test]
fn a_tied_map_takes_the_encoders_errors_away() {
    let folder = folder();
    let (without, phases, tied) = (
        noise(&folder, ""),
        noise(&folder, "--map full.map"),
        noise(&folder, "--map full.map --z Z"),
    );
    assert!(tied < 0.1 * without, "{tied} of {without}");
    assert!(phases < 0.99 * without && tied < 0.2 * phases, "{phases}");
}

#[test]
fn the_report_says_when_the_map_was_tied() {
    let folder = folder();
    let report = folder.json("replay feed.vcd --z Z --map full.map");
    let map = &report["map"];
    assert_eq!(
        keys(map),
        [
            "edges_per_revolution",
            "file",
            "form",
            "slips",
            "state",
            "tied_at_tick"
        ]
    );
    assert_eq!(
        (&map["form"], &map["state"], &map["slips"]),
        (&"full".into(), &"tied".into(), &0.into())
    );
    assert_eq!(number(map, "/edges_per_revolution"), 400.0);
    // Edge 0 is passed 150 d after the start, at 2 d a tick.
    let tick = number(map, "/tied_at_tick");
    assert!((75.0..77.0).contains(&tick), "{tick}");
    let printed = folder.printed("replay feed.vcd --z Z --map full.map");
    assert_says(
        &printed,
        &[&format!(
            "map full.map: full, 400 edges a revolution, tied to the index at tick {tick}, 0 slips\n"
        )],
    );
    assert!(!printed.contains("warning"), "{printed}");
    assert!(folder.json("replay feed.vcd")["map"].is_null());
}

#[test]
fn count_and_position_are_still_told_from_the_start() {
    let folder = folder();
    let column = |arguments: &str, name: &str| {
        folder.printed(&format!("replay feed.vcd {ALONE} {arguments} --csv x.csv"));
        Table::read(&folder.path("x.csv")).column(name)
    };
    let mapped = "--map full.map --z Z";
    assert_eq!(column(mapped, "count_d"), column("", "count_d"));
    for (one, other) in column(mapped, "position_d")
        .iter()
        .zip(column("", "position_d"))
    {
        assert!((one - other).abs() < 1.5, "{one} {other}");
    }
}

#[test]
fn a_map_that_is_not_tied_is_told() {
    let folder = folder();
    let map = |arguments: &str| folder.json(&format!("replay {arguments}"))["map"].clone();
    let without = map("feed.vcd --map full.map");
    assert!(without["state"] == "unfound" && without["tied_at_tick"].is_null());
    let printed = folder.printed("replay feed.vcd --map full.map");
    assert_says(&printed, &["never tied", "warning: without", "--z"]);
    // One revolution less a bit, without its index.
    let mut recording = feed(10, i64::MAX, 0);
    recording.changes.truncate(380);
    recording.duration = 190_000;
    folder.write("part.vcd", sigrok_vcd(&recording, &["A", "B", "Z"]));
    let printed = folder.printed("replay part.vcd --map full.map --z Z");
    assert_says(&printed, &["the index was never found", "whole revolution"]);
    let phases = map("feed.vcd --map phases.map");
    assert_eq!(phases["state"], "phases only");
    let printed = folder.printed("replay feed.vcd --map phases.map");
    assert_says(
        &printed,
        &["phases, 400 edges a revolution, needs no index"],
    );
    assert!(!printed.contains("warning"), "{printed}");
}

#[test]
fn slips_are_told() {
    let folder = folder();
    let report = folder.json("replay slips.vcd --map full.map --z Z");
    // The index moves once; after it the next one agrees, and the map is tied anew.
    assert_eq!(report["map"]["slips"], 1);
    assert_eq!(report["map"]["state"], "tied");
    let printed = folder.printed("replay slips.vcd --map full.map --z Z");
    assert_says(&printed, &["1 slips"]);
}

#[test]
fn maps_that_cannot_be_used_are_refused() {
    let folder = folder();
    let refused = |file: &str| folder.refused(1, &format!("replay feed.vcd --map {file} --json"));
    assert_says(
        &refused("none.map"),
        &["none.map: cannot be read", "check the path"],
    );
    assert_says(&refused("feed.vcd"), &["feed.vcd: ", "no encoder map"]);
    let mut image = map(Form::Full);
    folder.write("cut.map", &image[..100]);
    assert_says(&refused("cut.map"), &["cut.map: ", "cut off: 100 bytes"]);
    image[200] ^= 1;
    folder.write("damaged.map", image);
    assert_says(&refused("damaged.map"), &["damaged.map: ", "write it anew"]);
    let message = folder.refused(2, "replay feed.vcd --map full.map --csv full.map");
    assert_says(&message, &["full.map", "is the file that is read"]);
}

#[test]
fn filters_are_tuned_with_the_map_too() {
    let folder = folder();
    let best = |arguments: &str| {
        let report = folder.json(&format!("tune-filter feed.vcd {arguments}"));
        let sweep = report["sweep"].as_array().expect("entries");
        let entry = sweep
            .iter()
            .find(|entry| entry["estimator"] == "polynomial" && entry["value"] == 15.0);
        (
            number(entry.expect("an entry"), "/sigma_a"),
            report["map"]["state"].clone(),
        )
    };
    let ((without, none), (with, tied)) = (best(""), best("--map full.map --z Z"));
    assert!(none.is_null() && tied == "tied");
    assert!(with < 0.2 * without, "{with} of {without}");
    let printed = folder.printed("tune-filter feed.vcd --map full.map");
    assert_says(&printed, &["never tied", "warning: without", "--z"]);
}
