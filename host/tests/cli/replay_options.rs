//! `leadscrew replay`: channels, estimators, spans, and what is counted where.

use leadscrew::estimator::EstimatorConfig;
use leadscrew_host::recording::{Change, Levels, Recording};

use crate::capture_files::sigrok_vcd;
use crate::scenes::{RAMP_EDGES, levels_at, put_ramp, ramp};
use crate::table::Table;
use crate::{Folder, assert_says, keys, number};

#[test]
fn channels_swapped_count_backward() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    for channels in ["--a 1 --b 0", "--a libsigrok.1 --b libsigrok.0"] {
        let report = folder.json(&format!("replay ramp.vcd {channels}"));
        assert_eq!(report["final_count"], -RAMP_EDGES, "{channels}");
        assert_eq!(report["edges"], RAMP_EDGES);
    }
}

#[test]
fn a_name_goes_before_an_index() {
    let folder = Folder::new();
    // Names as sigrok gives them, but the other way round: B is called 0.
    folder.write("crossed.vcd", sigrok_vcd(&ramp(), &["1", "0"]));
    let final_count = |channels: &str| {
        folder.json(&format!("replay crossed.vcd {channels}"))["final_count"].clone()
    };
    assert_eq!(final_count(""), RAMP_EDGES);
    assert_eq!(final_count("--a 0 --b 1"), -RAMP_EDGES);
    folder.write("named.vcd", sigrok_vcd(&ramp(), &["A", "B"]));
    let by_index = folder.json("replay named.vcd --a 1 --b 0");
    assert_eq!(by_index["final_count"], -RAMP_EDGES);
}

#[test]
fn an_index_channel_is_read_beside_a_and_b() {
    let folder = Folder::new();
    let mut recording = ramp();
    for change in &mut recording.changes {
        change.levels.z = (3000..3003).contains(&(change.time / 100));
    }
    folder.write("index.vcd", sigrok_vcd(&recording, &["A", "B", "Z"]));
    let with = folder.json("replay index.vcd --z Z");
    assert_eq!(with["edges"], RAMP_EDGES);
    assert_eq!(with, folder.json("replay index.vcd"));
    let message = folder.refused(1, "replay index.vcd --z B");
    assert_says(&message, &["both the channel", "--z"]);
}

#[test]
fn one_estimator_alone() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    let all = folder.json("replay ramp.vcd");
    let one = folder.json("replay ramp.vcd --estimator simple --csv x.csv --plot x.svg");
    assert_eq!(keys(&one["estimators"]), ["simple"]);
    assert_eq!(one["estimators"]["simple"], all["estimators"]["simple"]);
    assert_eq!(
        Table::read(&folder.path("x.csv")).column("lag_x_ticks")[0],
        7.0
    );
    let svg = folder.read("x.svg");
    assert!(svg.contains("simple") && !svg.contains("gaussian"));
}

#[test]
fn a_curve_looks_the_same_alone_and_among_others() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    let colours = |arguments: &str| {
        folder.printed(&format!("replay ramp.vcd --plot x.svg {arguments}"));
        curve_colours(&folder.read("x.svg"))
    };
    let all = colours("");
    assert_eq!(all.len(), EstimatorConfig::NAMES.len());
    for (index, name) in EstimatorConfig::NAMES.iter().enumerate() {
        assert_eq!(
            colours(&format!("--estimator {name}")),
            all[index..=index],
            "{name}"
        );
    }
}

/// Colours of the curves of a figure, each once, in order of drawing.
fn curve_colours(svg: &str) -> Vec<String> {
    let mut colours = Vec::new();
    for path in svg.split("<path ").skip(1) {
        let (_, colour) = path.split_once("stroke=\"").expect("a curve has a colour");
        let colour = colour.split('"').next().unwrap_or_default().to_owned();
        if !colours.contains(&colour) {
            colours.push(colour);
        }
    }
    colours
}

#[test]
fn an_unknown_estimator_lists_the_known() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    let message = folder.refused(2, "replay ramp.vcd --estimator kalman --json");
    assert_says(&message, &["kalman", &EstimatorConfig::NAMES.join(", ")]);
}

#[test]
fn spans_that_are_none_are_bad_usage() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    for span in [
        "--from-s -1",
        "--to-s -1",
        "--to-s 0",
        "--from-s 0.3 --to-s 0.2",
        "--from-s 0.2 --to-s 0.2",
        "--from-s nan",
        "--to-s nan",
        "--from-s inf",
    ] {
        let message = folder.refused(2, &format!("replay ramp.vcd {span} --json"));
        assert_says(
            &message,
            &["--from-s", "--to-s", "the span must begin at 0 or later"],
        );
    }
}

#[test]
fn a_span_never_reaches_into_warm_up() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    let fit = |span: &str| folder.json(&format!("replay ramp.vcd {span}"));
    assert_eq!(fit("--from-s 0"), fit(""));
    assert_eq!(fit("--from-s 0 --to-s 99"), fit(""));
}

#[test]
fn a_span_without_ticks_has_no_slope() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    let report = folder.json("replay ramp.vcd --from-s 5");
    assert!(report["estimators"]["simple"]["acceleration_fit"].is_null());
    assert!(number(&report, "/estimators/simple/velocity_peak") > 40.0);
    assert_says(&folder.printed("replay ramp.vcd --from-s 5"), &[" - "]);
}

#[test]
fn a_capture_shorter_than_warm_up_has_no_figures() {
    let folder = Folder::new();
    let recording = Recording {
        duration: 4_000,
        changes: ramp().changes[..1].to_vec(),
        ..ramp()
    };
    folder.write("short.vcd", sigrok_vcd(&recording, &["0", "1"]));
    let report = folder.json("replay short.vcd");
    assert_eq!((&report["edges"], &report["ticks"]), (&1.into(), &5.into()));
    for figure in ["velocity_peak", "acceleration_rms", "acceleration_fit"] {
        assert!(
            report["estimators"]["gaussian"][figure].is_null(),
            "{figure}"
        );
    }
}

#[test]
fn counts_cover_the_file_although_ticks_end_before_it() {
    let folder = Folder::new();
    // Two edges after the last tick, at 1 ms and 2 ms of 2.9 ms.
    let edge = |(count, time): (i64, u64)| Change {
        time,
        levels: levels_at(count),
    };
    let recording = Recording {
        clock_hz: 1_000_000,
        duration: 2_900,
        initial: Levels::default(),
        changes: [(1, 1_000), (2, 1_001), (3, 2_000), (4, 2_001), (5, 2_900)]
            .map(edge)
            .to_vec(),
    };
    folder.write("tail.vcd", sigrok_vcd(&recording, &["0", "1"]));
    let report = folder.json("replay tail.vcd --csv x.csv");
    assert_eq!(
        (&report["edges"], &report["final_count"]),
        (&5.into(), &5.into())
    );
    assert_eq!(report["ticks"], 3);
    // An edge at the very instant of a tick belongs to it.
    assert_eq!(
        Table::read(&folder.path("x.csv")).column("count_d"),
        [0.0, 1.0, 3.0]
    );
}

#[test]
fn counts_start_at_zero_whatever_the_levels_at_first() {
    let folder = Folder::new();
    let from = |first: i64| {
        let change = |count: i64| Change {
            time: (count * 300) as u64,
            levels: levels_at(first + count),
        };
        let recording = Recording {
            clock_hz: 1_000_000,
            duration: 60_000,
            initial: levels_at(first),
            changes: (1..150).map(change).collect(),
        };
        let name = format!("from_{first}.vcd");
        folder.write(&name, sigrok_vcd(&recording, &["0", "1"]));
        let report = folder.json(&format!("replay {name} --csv x.csv"));
        let table = Table::read(&folder.path("x.csv"));
        let columns = ["count_d", "position_d", "velocity_d_per_tick"];
        (
            report["final_count"].clone(),
            columns.map(|name| table.column(name)),
        )
    };
    let expected = from(0);
    assert_eq!((&expected.0, expected.1[0][0]), (&149.into(), 0.0));
    for first in 1..4 {
        assert_eq!(from(first), expected, "{first}");
    }
}

#[test]
fn both_channels_at_once_are_one_illegal_transition() {
    let folder = Folder::new();
    let mut recording = ramp();
    // Without one edge, two become one change of both channels.
    recording.changes.remove(6_000);
    folder.write("hole.vcd", sigrok_vcd(&recording, &["0", "1"]));
    let report = folder.json("replay hole.vcd");
    assert_eq!(report["illegal"], 1);
    assert_eq!(report["edges"], RAMP_EDGES - 2);
    assert_eq!(report["final_count"], RAMP_EDGES - 2);
    let printed = folder.printed("replay hole.vcd");
    assert_says(&printed, &["1 illegal", "warning: A and B changed at once"]);
}

#[test]
fn an_encoder_too_fast_for_the_tick_is_told() {
    let folder = Folder::new();
    let change = |count: i64| Change {
        time: count as u64,
        levels: levels_at(count),
    };
    let recording = Recording {
        clock_hz: 1_000_000,
        duration: 60_000,
        initial: Levels::default(),
        changes: (1..60_000).map(change).collect(),
    };
    folder.write("fast.vcd", sigrok_vcd(&recording, &["0", "1"]));
    // 10 000 d a tick; a velocity holds 2 047.
    assert_eq!(
        folder.json("replay fast.vcd --tick-hz 100")["overspeed_ticks"],
        6
    );
    let printed = folder.printed("replay fast.vcd --tick-hz 100");
    assert_says(
        &printed,
        &["warning: 6 ticks with more than 2047 d", "raise --tick-hz"],
    );
    let slower = folder.printed("replay fast.vcd --tick-hz 1000");
    assert!(!slower.contains("warning"), "{slower}");
}

#[test]
fn channels_that_never_change_are_told() {
    let folder = Folder::new();
    let recording = Recording {
        changes: Vec::new(),
        ..ramp()
    };
    folder.write("still.vcd", sigrok_vcd(&recording, &["0", "1"]));
    let printed = folder.printed("replay still.vcd");
    assert_says(
        &printed,
        &["0 edges", "warning: A and B never change", "--a and --b"],
    );
}
