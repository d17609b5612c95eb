//! Saleae's CSV: exact times in every notation.

use super::{assert_says, changes, levels, read_bytes, recorded, refused, refused_with, select};

#[test]
fn nanoseconds_from_before_the_trigger() {
    let recording = recorded(
        "Time [s],Channel 0,Channel 1\n-0.000002000,1,0\n0.000000000,0,0\n0.000001500,0,1\n\
         0.000004000,1,1\n0.000010000,1,1\n",
    );
    assert_eq!(recording.clock_hz, 1_000_000_000);
    assert_eq!(recording.initial, levels("10"));
    assert_eq!(
        recording.changes,
        changes(&[(2_000, "00"), (3_500, "01"), (6_000, "11")])
    );
    assert_eq!(recording.duration, 12_000);
}

#[test]
fn the_clock_is_the_finest_place_of_all_rows() {
    let recording = recorded("Time [s],A,B\n1,0,0\n1.5,1,0\n2.25e0,1,1\n2.5000001,0,1\n3,0,1\n");
    assert_eq!(recording.clock_hz, 10_000_000);
    let expected = [(5_000_000, "10"), (12_500_000, "11"), (15_000_001, "01")];
    assert_eq!(recording.changes, changes(&expected));
    assert_eq!(recording.duration, 20_000_000);
}

#[test]
fn padded_zeros_make_no_finer_clock() {
    // The layout of Logic 1 and of Kingst's analysers.
    let recording = recorded(
        "Time[s], Channel 0, Channel 1\n0.000000000000000, 1, 1\n7.642110550000000, 1, 0\n",
    );
    assert_eq!(
        (recording.clock_hz, recording.duration),
        (1_000_000_000, 7_642_110_550)
    );
    assert_eq!(recording.changes, changes(&[(7_642_110_550, "10")]));
}

#[test]
fn femtoseconds_are_exact() {
    // 2^53 + 1 fs: a floating-point number would round the last digit away.
    let recording = recorded("Time [s],A,B\n0,0,0\n9.007199254740993,1,0\n1e1,1,0\n");
    assert_eq!(recording.clock_hz, 1_000_000_000_000_000);
    assert_eq!(recording.changes, changes(&[(9_007_199_254_740_993, "10")]));
}

#[test]
fn rows_of_one_time_are_one_change() {
    let recording = recorded("Time [s],A,B\n0.0,0,0\n0.1,1,0\n0.1,1,1\n0.2,1,1\n");
    assert_eq!(recording.changes, changes(&[(1, "11")]));
}

#[test]
fn unknown_levels_at_either_end() {
    // The end row of an export with gaps.
    let recording = recorded("Time [s],A,B\n0.0,0,X\n0.1,1,X\n0.2,1,1\n0.3,1,0\n0.4,X,X\n");
    assert_eq!(recording.initial, levels("01"));
    assert_eq!(recording.changes, changes(&[(1, "11"), (3, "10")]));
    assert_eq!(recording.duration, 4);
}

#[test]
fn a_gap_is_an_error_where_it_begins() {
    let message = refused("Time [s],A,B\n0.0,0,0\n0.1,0,X\n0.25,0,X\n0.3,0,1\n");
    assert_says(
        &message,
        &["line 3: ", "level of B is unknown from here", "gap"],
    );
}

#[test]
fn a_gap_keeps_its_place_when_the_clock_gets_finer() {
    let recording = recorded("Time [s],A,B\n0.0,0,0\n0.2,1,0\n0.3,X,X\n0.45,X,X\n");
    assert_eq!((recording.clock_hz, recording.duration), (100, 30));
    assert_eq!(recording.changes, changes(&[(20, "10")]));
}

#[test]
fn names_are_exact_and_may_be_quoted() {
    let text = "Time [s],\"Encoder, A\",Channel 0 :),Channel 1\n0.0,0,0,0\n0.1,0,0,1\n0.2,0,1,1\n";
    for channels in [select("Channel 1", "Channel 0 :)"), select("2", "1")] {
        let recording = read_bytes(text, &channels, None).expect("channels");
        assert_eq!(recording.changes, changes(&[(1, "10"), (2, "11")]));
    }
    let message = refused_with(text, &select("channel 1", "0"), None);
    assert_says(
        &message,
        &["no channel `channel 1`", "`Encoder, A` (index 0)"],
    );
}

#[test]
fn one_name_twice() {
    let text = "Time [s],Channel 1,Channel 1,Channel 2\n0.0,0,0,0\n";
    let message = refused_with(text, &select("Channel 1", "Channel 2"), None);
    assert_says(
        &message,
        &[
            "several channels",
            "`Channel 1` (index 0), `Channel 1` (index 1)",
        ],
    );
}

#[test]
fn one_channel() {
    let message = refused("Time [s],Channel 3\n0.0,0\n0.1,1\n");
    assert_says(
        &message,
        &["expected two one-bit signals", "found `Channel 3`"],
    );
    let message = refused_with(
        "Time [s],A,B\n0.0,0,0\n",
        &super::ChannelSelection {
            a: Some("B".into()),
            ..Default::default()
        },
        None,
    );
    assert_says(
        &message,
        &["A and B are both the channel `B`", "give both --a and --b"],
    );
}

#[test]
fn broken_rows() {
    let header = |rows: &str| format!("Time [s],A,B\n{rows}");
    let long = format!("0.1,{}", "0,".repeat(100));
    let cases: [(String, &[&str]); 12] = [
        (
            header("0.0,0,0\n\r\n0.1,1\n"),
            &["line 4: ", "3 columns as in the header", "`0.1,1`"],
        ),
        (header(&long), &["line 2: ", "3 columns", "0,0,…`"]),
        (
            header("0.0,0,0\n0.1,0,high\n"),
            &["line 3: ", "0, 1 or X for B in column 3", "`0.1,0,high`"],
        ),
        (
            header("0.0,0,0\nsoon,0,0\n"),
            &["line 3: ", "seconds such as 0.000125", "`soon,0,0`"],
        ),
        (
            header("2026-01-04T17:57:55.000000001Z,0,0\n"),
            &["line 2: ", "seconds", "ISO 8601"],
        ),
        (
            header("0.0,0,0\n1e-16,1,0\n"),
            &["line 3: ", "at most 15 decimal places", "nine"],
        ),
        (
            header("0.2,0,0\n0.1,1,0\n"),
            &["line 3: ", "0.1 comes after 0.2", "never decrease"],
        ),
        (
            header("-1,0,0\n-2.5,1,0\n"),
            &["line 3: ", "-2.5 comes after -1"],
        ),
        (header("0,0,0\n1e20,1,0\n"), &["line 3: ", "2^64"]),
        (
            header("0,0,0\n18447,1,0\n18447.000000000000001,0,0\n"),
            &["line 4: ", "2^64"],
        ),
        (
            "Time,A,B\n0.0,0,0\n".into(),
            &["line 1: ", "`Time [s],`", "`Time,A,B`", "ISO 8601"],
        ),
        (
            "Time [ms],A,B\n0.0,0,0\n".into(),
            &["line 1: ", "`Time [s],`", "in seconds only"],
        ),
    ];
    for (content, parts) in cases {
        assert_says(&refused(content), parts);
    }
    assert_says(&refused(header("")), &["no samples"]);
}
