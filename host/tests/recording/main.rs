//! Captures of logic analysers: every format into the same recording, every fault with its words.

#[path = "../support/capture_files.rs"]
mod capture_files;
mod every_format;
mod faults;
mod saleae_csv;
mod sigrok_csv;
mod vcd;

use std::path::PathBuf;
use std::process::Command;

use leadscrew_host::recording::{
    Change, ChannelSelection, Levels, Recording, RecordingError, read,
};

/// Reads a file of this content.
fn read_bytes(
    content: impl AsRef<[u8]>,
    channels: &ChannelSelection,
    samplerate_hz: Option<u64>,
) -> Result<Recording, RecordingError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    // The name tells nothing: formats are told by content.
    let path = folder.path().join("capture.txt");
    std::fs::write(&path, content).expect("the file is written");
    read(&path, channels, samplerate_hz)
}

/// Reads a good file with its default channels.
fn recorded(content: impl AsRef<[u8]>) -> Recording {
    read_bytes(content, &ChannelSelection::default(), None).expect("a capture")
}

/// Reads a bad file and says what the message says, after the path.
fn refused(content: impl AsRef<[u8]>) -> String {
    refused_with(content, &ChannelSelection::default(), None)
}

fn refused_with(
    content: impl AsRef<[u8]>,
    channels: &ChannelSelection,
    samplerate_hz: Option<u64>,
) -> String {
    let error = read_bytes(content, channels, samplerate_hz).expect_err("a refusal");
    let message = error.to_string();
    let (path, rest) = message
        .split_once("capture.txt: ")
        .expect("the file is named");
    assert!(PathBuf::from(path).is_absolute(), "{message}");
    assert_eq!(rest.starts_with("line "), error.line.is_some(), "{message}");
    rest.to_owned()
}

/// Asserts that the message has all of these parts.
#[track_caller]
fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

fn select(a: &str, b: &str) -> ChannelSelection {
    ChannelSelection {
        a: Some(a.into()),
        b: Some(b.into()),
        z: None,
    }
}

fn select_z(a: &str, b: &str, z: &str) -> ChannelSelection {
    ChannelSelection {
        z: Some(z.into()),
        ..select(a, b)
    }
}

/// Levels from a text such as `10` or `101`.
fn levels(text: &str) -> Levels {
    let mut bits = text.chars().map(|bit| bit == '1');
    let mut next = || bits.next().unwrap_or(false);
    Levels {
        a: next(),
        b: next(),
        z: next(),
    }
}

fn changes(texts: &[(u64, &str)]) -> Vec<Change> {
    texts
        .iter()
        .map(|(time, text)| Change {
            time: *time,
            levels: levels(text),
        })
        .collect()
}

/// A file of the folder of captures, where there is such a folder.
fn capture(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("LEADSCREW_CAPTURES");
    if folder.is_none() {
        eprintln!("skipped: LEADSCREW_CAPTURES is not set");
    }
    Some(PathBuf::from(folder?).join(name))
}

#[test]
fn the_ramp_of_the_sigrok_project() {
    let Some(path) = capture("rotary-ramp.vcd") else {
        return;
    };
    for channels in [
        ChannelSelection::default(),
        select("0", "1"),
        select("libsigrok.0", "1"),
    ] {
        let ramp = read(&path, &channels, None).expect("the ramp");
        assert_eq!(ramp.clock_hz, 1_000_000);
        assert_eq!(ramp.duration, 600_000);
        assert_eq!(ramp.initial, Levels::default());
        assert_eq!(ramp.changes.len(), 12_732);
        assert_eq!(ramp.changes[..2], changes(&[(3_760, "10"), (5_318, "11")]));
        assert_eq!(ramp.changes[12_731..], changes(&[(597_636, "00")]));
    }
}

#[test]
fn the_ramp_as_sigrok_cli_exports_it() {
    let (Some(vcd), Some(session)) = (capture("rotary-ramp.vcd"), capture("rotary-ramp.sr")) else {
        return;
    };
    let expected = read(&vcd, &ChannelSelection::default(), None).expect("the ramp");
    for format in [
        "vcd",
        "csv",
        "csv:label=channel",
        "csv:label=off",
        "csv:header=false",
        "csv:time=true:dedup=true",
        "csv:time=true:trigger=true:label=channel",
    ] {
        let export = Command::new("sigrok-cli")
            .arg("-i")
            .arg(&session)
            .args(["-O", format])
            .output();
        let Ok(export) = export else {
            eprintln!("skipped: sigrok-cli is not installed");
            return;
        };
        let rate = format.contains("header").then_some(1_000_000);
        let ramp = read_bytes(export.stdout, &ChannelSelection::default(), rate).expect(format);
        // Twelve thousand changes are no message.
        assert!(ramp == expected, "{format}");
    }
}
