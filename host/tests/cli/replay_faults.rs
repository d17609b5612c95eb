//! `leadscrew replay` of files that are no captures.

use crate::scenes::{put_ramp, short_walk};
use crate::{Folder, assert_says};

/// What is said of a file of that content; its name tells nothing.
#[track_caller]
fn refused(content: impl AsRef<[u8]>) -> String {
    let folder = Folder::new();
    folder.write("capture", content);
    let message = folder.refused(1, "replay capture --json --csv x.csv --plot x.png");
    assert!(message.starts_with("error: capture: "), "{message}");
    message
}

#[test]
fn files_without_a_capture() {
    for empty in ["", "\n", "  \n\n"] {
        assert_says(&refused(empty), &["is empty: expected a capture", "VCD"]);
    }
    assert_says(
        &refused("hello\n"),
        &["starts with `hello`: expected a capture"],
    );
    assert_says(&refused([0xff, 0xfe, 0, 1, 2]), &["UTF-8"]);
}

#[test]
fn a_vcd_with_one_channel() {
    let one =
        "$timescale 1 us $end\n$var wire 1 ! A $end\n$enddefinitions $end\n#0 0!\n#5 1!\n#9\n";
    assert_says(
        &refused(one),
        &["expected two one-bit signals for A and B", "`A`"],
    );
}

#[test]
fn broken_lines_are_named() {
    let row = "; Channels (2/2): A, B\n; Samplerate: 1 MHz\n0,0\n1,0\n1,oops\n1,1\n";
    assert_says(&refused(row), &["line 5", "1,oops", "expected"]);
    let row = "Time [s],A,B\n0.0,0,0\n0.001,1,0\nx,1,1\n";
    assert_says(&refused(row), &["line 4", "expected"]);
    let backwards = short_walk().replace("#1400 ", "#14 ");
    assert_says(&refused(backwards), &["line ", "time #14 comes after #700"]);
}

#[test]
fn files_that_cannot_be_read() {
    let folder = Folder::new();
    let message = folder.refused(1, "replay absent.vcd --json");
    assert_says(
        &message,
        &["absent.vcd", "cannot be read", "check the path"],
    );
    std::fs::create_dir(folder.path("folder.vcd")).expect("a folder");
    folder.refused(1, "replay folder.vcd");
}

#[test]
fn tick_rates_out_of_range_name_the_range() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    for rate in ["0", "1e9", "-1000", "nan", "inf"] {
        let message = folder.refused(2, &format!("replay ramp.vcd --tick-hz {rate} --json"));
        assert_says(&message, &["--tick-hz", "100 to 40000 Hz"]);
    }
}

#[test]
fn sample_rates_that_are_none() {
    let folder = Folder::new();
    folder.write("rows.csv", "0,0\n1,0\n1,1\n");
    assert_says(
        &folder.refused(1, "replay rows.csv --samplerate 0"),
        &["--samplerate"],
    );
    for rate in ["-1", "fast", "1.5"] {
        assert_says(
            &folder.refused(2, &format!("replay rows.csv --samplerate {rate}")),
            &[rate],
        );
    }
}

#[test]
fn channels_that_are_not_there_list_those_that_are() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    let message = folder.refused(1, "replay ramp.vcd --a 7 --json");
    assert_says(
        &message,
        &["no channel `7` for A", "libsigrok.0", "libsigrok.1", "--a"],
    );
    let message = folder.refused(1, "replay ramp.vcd --b 0");
    assert_says(&message, &["A and B are both the channel"]);
}

#[test]
fn a_capture_of_years_is_refused_before_it_fills_the_memory() {
    let vcd = "$timescale 1 s $end\n$var wire 1 ! A $end\n$var wire 1 \" B $end\n\
               $enddefinitions $end\n#0 0! 0\"\n#1 1!\n#18446744073709551615\n";
    let message = refused(vcd);
    assert_says(
        &message,
        &[
            "ticks at 1000 Hz",
            "lower --tick-hz or export a shorter range",
        ],
    );
}
