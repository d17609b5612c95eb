//! One recording, written in every format by code that shares nothing with the readers, reads back
//! the same.

use leadscrew_host::recording::{Change, ChannelSelection, Levels, Recording};
use proptest::prelude::*;

use super::capture_files::{cells, saleae_csv, samples, sigrok_csv, sigrok_vcd};
use super::{read_bytes, recorded, select_z};

const NAMES: [&str; 3] = ["A", "B", "Z"];

/// Up to 200 samples of levels, at one of the rates that all formats can state.
fn any_recording() -> impl Strategy<Value = Recording> {
    let steps = prop::collection::vec((1_u64..5, 1_u8..8), 0..60);
    let clocks = prop::sample::select(vec![1_000_u64, 1_000_000, 10_000_000, 1_000_000_000]);
    (steps, 0_u8..8, 1_u64..9, clocks).prop_map(|(steps, first, rest, clock_hz)| {
        let (mut time, mut bits) = (0, first);
        let mut changes = Vec::new();
        for (wait, flipped) in steps {
            time += wait;
            bits ^= flipped;
            changes.push(Change {
                time,
                levels: levels_of(bits),
            });
        }
        Recording {
            clock_hz,
            duration: time + rest,
            initial: levels_of(first),
            changes,
        }
    })
}

fn levels_of(bits: u8) -> Levels {
    Levels {
        a: bits & 1 != 0,
        b: bits & 2 != 0,
        z: bits & 4 != 0,
    }
}

/// sigrok's CSV with `time=true:dedup=true`: rows of changes and the last sample, at the sample's
/// number times the cut period.
fn sigrok_timed_csv(recording: &Recording, rate: &str, period: u64) -> String {
    let mut text =
        format!("; Channels (3/3): A, B, Z\n; Samplerate: {rate}\nnanoseconds,logic,logic,logic\n");
    let mut before = None;
    for (time, levels) in samples(recording) {
        if before != Some(levels) || time + 1 == recording.duration {
            text += &format!("{},{}\n", (time + 1) * period, cells(levels, 3));
        }
        before = Some(levels);
    }
    text
}

/// What gets a file past detection.
const HEADS: [&str; 6] = [
    "",
    ";",
    "0,1\n",
    "Time [s],A,B\n",
    "$timescale 1 us $end $var wire 1 ! A $end",
    "$timescale 1 us $end $var wire 1 ! A $end $var wire 1 \" B $end $enddefinitions $end\n#0",
];

proptest! {
    #[test]
    fn reads_back_what_was_written(recording in any_recording(), start in -3_000_i64..3_000) {
        let abz = select_z("A", "B", "Z");
        for text in [
            sigrok_vcd(&recording, &NAMES),
            sigrok_csv(&recording, &NAMES),
            saleae_csv(&recording, &NAMES, start),
        ] {
            prop_assert_eq!(&read_bytes(&text, &abz, None).unwrap(), &recording, "{}", text);
            // Windows line ends and a byte-order mark, as after a spreadsheet.
            let windows = format!("\u{feff}{}", text.replace('\n', "\r\n"));
            prop_assert_eq!(&read_bytes(&windows, &abz, None).unwrap(), &recording);
        }
    }

    #[test]
    fn the_time_column_of_sigrok_counts_samples(recording in any_recording()) {
        // 1/24 us is 41.67 ns, which libsigrok cuts to 41.
        let text = sigrok_timed_csv(&recording, "24 MHz", 41);
        let expected = Recording { clock_hz: 24_000_000, ..recording };
        prop_assert_eq!(&read_bytes(&text, &select_z("A", "B", "Z"), None).unwrap(), &expected);
    }

    #[test]
    fn no_bytes_make_a_reader_panic(
        head in prop::sample::select(HEADS.to_vec()),
        tail in prop::collection::vec(
            prop_oneof![any::<u8>(), prop::sample::select(b"019,.-e#$!\"bxX\n ;".to_vec())],
            0..80,
        ),
    ) {
        let content = [head.as_bytes(), &tail].concat();
        let _ = read_bytes(content, &ChannelSelection::default(), Some(1_000_000));
    }

    #[test]
    fn no_damage_to_a_capture_makes_a_reader_panic(
        recording in any_recording(),
        format in 0_usize..3,
        at in any::<prop::sample::Index>(),
        byte in any::<u8>(),
        cut in any::<bool>(),
    ) {
        let text = match format {
            0 => sigrok_vcd(&recording, &NAMES),
            1 => sigrok_csv(&recording, &NAMES),
            _ => saleae_csv(&recording, &NAMES, 0),
        };
        let mut content = text.into_bytes();
        let at = at.index(content.len());
        content[at] = byte;
        if cut {
            content.truncate(at);
        }
        let _ = read_bytes(content, &ChannelSelection::default(), None);
    }
}

#[test]
fn z_is_low_where_it_is_not_asked_for() {
    let recording = Recording {
        clock_hz: 1_000_000,
        duration: 9,
        initial: levels_of(0),
        // The change of Z alone is none of A and B.
        changes: vec![
            Change {
                time: 3,
                levels: levels_of(4),
            },
            Change {
                time: 5,
                levels: levels_of(5),
            },
        ],
    };
    let without = Recording {
        changes: vec![Change {
            time: 5,
            levels: levels_of(1),
        }],
        ..recording.clone()
    };
    assert_eq!(recorded(sigrok_vcd(&recording, &NAMES)), without);
    assert_eq!(recorded(sigrok_csv(&recording, &NAMES)), without);
    assert_eq!(recorded(saleae_csv(&recording, &NAMES, 0)), without);
}

#[test]
fn a_simultaneous_change_is_one_change() {
    let recording = Recording {
        clock_hz: 1_000_000,
        duration: 9,
        initial: levels_of(0),
        changes: vec![Change {
            time: 3,
            levels: levels_of(3),
        }],
    };
    assert_eq!(
        recorded(sigrok_vcd(&recording, &NAMES[..2])).changes,
        recording.changes
    );
    assert_eq!(
        recorded(sigrok_csv(&recording, &NAMES[..2])).changes,
        recording.changes
    );
    assert_eq!(
        recorded(saleae_csv(&recording, &NAMES[..2], 0)).changes,
        recording.changes
    );
}
