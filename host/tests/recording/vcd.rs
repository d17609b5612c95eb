//! VCD beyond sigrok's own layout.

use super::{assert_says, changes, levels, read_bytes, recorded, refused, refused_with, select};

/// Two wires and a body.
fn two_wires(timescale: &str, body: &str) -> String {
    format!(
        "$timescale {timescale} $end\n$var wire 1 ! A $end\n$var wire 1 \" B $end\n\
         $enddefinitions $end\n{body}"
    )
}

/// A design with scopes: a vector, one name in two scopes, one net under two names.
const DESIGN: &str = "$timescale 1ns $end\n$scope module top $end\n$var reg 8 d data $end\n\
    $var wire 1 ! a $end\n$scope module left $end\n$var wire 1 ! in $end\n$var wire 1 % a $end\n\
    $upscope $end\n$scope module right $end\n$var wire 1 & q [3] $end\n$var real 1 r v $end\n\
    $var wire 1 ' in $end\n$upscope $end\n$upscope $end\n$enddefinitions $end\n\
    #10 0! 0% 0& 0' b1010 d r1.5 r\n#20 1!\n#30 1%\n#40 1&\n#50 1'\n";

#[test]
fn timescales_from_femtoseconds_to_seconds() {
    let cases = [
        ("1 fs", 1_000_000_000_000_000),
        ("100 ps", 10_000_000_000),
        ("10 ns", 100_000_000),
        ("1us", 1_000_000),
        ("100 ms", 10),
        ("1 s", 1),
    ];
    for (timescale, clock_hz) in cases {
        let recording = recorded(two_wires(timescale, "#5 0! 0\"\n#7 1!\n#8\n"));
        assert_eq!(recording.clock_hz, clock_hz, "{timescale}");
        assert_eq!(recording.changes, changes(&[(2, "10")]), "{timescale}");
        assert_eq!(recording.duration, 3, "{timescale}");
    }
}

#[test]
fn a_timescale_that_is_no_whole_frequency_multiplies_the_times() {
    let recording = recorded(two_wires("10 s", "#5 0! 0\"\n#7 1!\n#8\n"));
    assert_eq!((recording.clock_hz, recording.duration), (1, 30));
    assert_eq!(recording.changes, changes(&[(20, "10")]));
}

#[test]
fn levels_before_the_first_timestamp_and_repeated_timestamps() {
    let body = "$dumpvars\n1!\n0\"\n$end\n#100\n#110 0!\n#110 1\"\n#120 1! 0!\n#130";
    let recording = recorded(two_wires("1 us", body));
    assert_eq!(recording.initial, levels("10"));
    // A pulse within one timestamp has no length; the last line has no line end.
    assert_eq!(recording.changes, changes(&[(10, "01")]));
    assert_eq!(recording.duration, 30);
}

#[test]
fn vectors_of_one_bit_are_levels() {
    let recording = recorded(two_wires("1 us", "#0 b0 ! b1 \"\n#1 b1 !\n"));
    assert_eq!(
        (recording.initial, recording.changes),
        (levels("01"), changes(&[(1, "11")]))
    );
}

#[test]
fn a_level_unknown_at_first_is_the_first_known_one() {
    let recording = recorded(two_wires(
        "1 us",
        "$dumpvars x! z\" $end\n#0\n#4 0!\n#6 1!\n#8 1\"\n",
    ));
    assert_eq!(recording.initial, levels("01"));
    assert_eq!(recording.changes, changes(&[(6, "11")]));
}

#[test]
fn levels_unknown_until_the_end_end_the_recording() {
    let recording = recorded(two_wires("1 us", "#0 0! 0\"\n#4 1!\n#6 x! x\"\n#9\n"));
    assert_eq!(
        (recording.duration, recording.changes),
        (6, changes(&[(4, "10")]))
    );
}

#[test]
fn a_gap_is_an_error_where_it_begins() {
    for rest in ["#8 0!", "#8 1!", "#8 1\""] {
        let message = refused(two_wires(
            "1 us",
            &format!("#0 0! 0\"\n#4 1!\n#6 x!\n{rest}\n"),
        ));
        assert_says(
            &message,
            &[
                "line 7: ",
                "level of A is unknown",
                "gap",
                "export the range",
            ],
        );
    }
}

#[test]
fn channels_by_path_name_and_index() {
    // Each selection, and the time at which its B rises.
    let cases = [
        ("top.a", "top.left.a", 20),
        ("0", "1", 20),
        ("top.left.in", "q[3]", 30),
        ("0", "top.right.in", 40),
        ("top.a", "3", 40),
    ];
    for (a, b, rises) in cases {
        let recording = read_bytes(DESIGN, &select(a, b), None).expect("channels");
        assert_eq!(
            recording.changes,
            changes(&[(10, "10"), (rises, "11")]),
            "{a} {b}"
        );
    }
    assert_eq!(recorded(DESIGN).changes, changes(&[(10, "10"), (20, "11")]));
}

#[test]
fn a_name_goes_before_an_index() {
    let swapped = "$timescale 1 us $end\n$var wire 1 ! 1 $end\n$var wire 1 \" 0 $end\n\
        $enddefinitions $end\n#0 0! 0\"\n#1 1\"\n#2\n";
    let recording = read_bytes(swapped, &select("0", "1"), None).expect("channels");
    assert_eq!(recording.changes, changes(&[(1, "10")]));
}

#[test]
fn channels_that_cannot_be_chosen() {
    let message = refused_with(DESIGN, &select("a", "top.right.in"), None);
    assert_says(
        &message,
        &[
            "several channels `a` for A",
            "`top.a` (index 0)",
            "`top.left.a` (index 1)",
        ],
    );
    assert_says(&message, &["--a", "full path"]);
    let message = refused_with(DESIGN, &select("top.a", "data"), None);
    assert_says(
        &message,
        &[
            "`data` for B",
            "is 8 bits wide",
            "`top.right.q[3]` (index 2)",
            "--b",
        ],
    );
    let message = refused_with(DESIGN, &select("v", "0"), None);
    assert_says(&message, &["`v` for A", "is of the type real", "--a"]);
    let message = refused_with(DESIGN, &select("0", "4"), None);
    assert_says(
        &message,
        &["no channel `4` for B", "`top.right.in` (index 3)", "--b"],
    );
    // The same net, under two names.
    let message = refused_with(DESIGN, &select("top.a", "left.in"), None);
    assert_says(&message, &["no channel `left.in`"]);
    let message = refused_with(DESIGN, &select("top.a", "top.left.in"), None);
    assert_says(
        &message,
        &[
            "A and B are both the channel `top.a`",
            "two different channels",
            "--b",
        ],
    );
}

#[test]
fn a_vcd_with_one_channel() {
    let one = "$timescale 1 us $end\n$scope module m $end\n$var wire 1 ! A $end\n\
        $var wire 8 \" bus $end\n$upscope $end\n$enddefinitions $end\n#0 0!\n";
    let message = refused(one);
    assert_says(
        &message,
        &[
            "expected two one-bit signals",
            "`m.A`, `m.bus` (which is 8 bits wide)",
        ],
    );
    let none = refused("$timescale 1 us $end\n$enddefinitions $end\n#0\n");
    assert_says(&none, &["expected two one-bit signals", "found none"]);
}

#[test]
fn broken_vcd_is_located() {
    let cases: [(String, &[&str]); 13] = [
        (
            two_wires("1 us", "#0 0! 0\"\n#5 1!\n#4 0!\n"),
            &["line 7: ", "#4 comes after #5", "never decrease"],
        ),
        (
            two_wires("1 us", "#0 0! 0\"\n#5 ?!\n"),
            &["line 6: ", "not valid VCD", "unexpected character", "again"],
        ),
        (
            two_wires("1 us", "#0 0! 0\"\n#5x\n"),
            &["line 6: ", "invalid digit"],
        ),
        (
            two_wires("1 us", "#0 0! 0\"\n#99999999999999999999\n"),
            &["line 6: ", "too large"],
        ),
        (
            two_wires("1 us", "#0 0! 0\"\n1"),
            &["line 6: ", "ends inside a command", "cut short"],
        ),
        (
            two_wires("1 us", "#0 0! 0\"\n#1 b01 !\n"),
            &["line 6: ", "value of A that is not one bit"],
        ),
        (
            two_wires("1 ks", ""),
            &["line 1: ", "invalid timescale unit", "expected s, ms, us"],
        ),
        (
            two_wires("0 us", ""),
            &["`$timescale` of zero", "`$timescale 1 us $end`"],
        ),
        (
            two_wires("10 s", "#0\n#9999999999999999999\n"),
            &["line 6: ", "2^64", "shorter range"],
        ),
        (
            "$var wire 1 ! A $end\n$enddefinitions $end\n".into(),
            &["no `$timescale`", "add it"],
        ),
        (
            "$timescale 1 us $end\n$var wire 1 ! CH 0 $end\n".into(),
            &["line 2: ", "expected `$end`", "no spaces"],
        ),
        (
            "$timescale 1 us $end\n#0 0!\n".into(),
            &["line 2: ", "data before `$enddefinitions`"],
        ),
        (
            "$timescale 1 us $end\n$var wire 1 ! A $end\n".into(),
            &["line 3: ", "ends before `$enddefinitions`"],
        ),
    ];
    for (content, parts) in cases {
        assert_says(&refused(content), parts);
    }
}

#[test]
fn a_vcd_without_levels() {
    assert_says(
        &refused(two_wires("1 us", "")),
        &["no samples", "capture again"],
    );
    let message = refused(two_wires("1 us", "#0 0!\n#5 1!\n"));
    assert_says(&message, &["never says whether B is 0 or 1", "--b"]);
}

#[test]
fn many_signals_are_not_all_listed() {
    let many: String = (0..40_000)
        .map(|index| format!("$var wire 1 s{index} net{index} $end\n"))
        .collect();
    let text = format!("$timescale 1 us $end\n{many}$enddefinitions $end\n#0\n");
    let message = refused_with(text, &select("A", "B"), None);
    assert_says(&message, &["`net15` (index 15) and 39984 more"]);
    assert!(!message.contains("net16"));
}

#[test]
fn deep_scopes_do_not_exhaust_the_stack() {
    let deep = "$scope module m $end\n".repeat(200_000);
    assert_says(
        &refused(format!("$timescale 1 us $end\n{deep}")),
        &["ends before"],
    );
}
