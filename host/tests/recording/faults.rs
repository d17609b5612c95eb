//! Files that are no capture at all.

use leadscrew_host::recording::{ChannelSelection, Problem, read};

use super::{assert_says, refused};

/// What every refusal of an unknown file offers.
const FORMATS: [&str; 3] = ["VCD (starts with `$`)", "sigrok CSV", "Saleae Logic 2 CSV"];

#[test]
fn an_empty_file() {
    for content in ["", "\n\n  \r\n", "\u{feff}"] {
        let message = refused(content);
        assert_says(&message, &["is empty"]);
        assert_says(&message, &FORMATS);
    }
}

#[test]
fn a_file_of_another_kind() {
    let message = refused("\n\nDear diary,\ntoday\n");
    assert_says(&message, &["line 3: starts with `Dear diary,`"]);
    assert_says(&message, &FORMATS);
    let message = refused(format!("{}\n", "word ".repeat(100)));
    assert_says(&message, &["word …`: expected"]);
}

#[test]
fn text_that_is_not_utf8() {
    let utf16: Vec<u8> = "\u{feff}; CSV\r\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let cases: [(&[u8], &str); 5] = [
        (&utf16, "line 1: "),
        (b"Time [s],\xc4,B\n0,0,0\n", "line 1: "),
        (b"Time [s],A,B\n0,0,0\n0.1,\xff,0\n", "line 3: "),
        (
            b"; Samplerate: 1 Hz\n; Channels (2/2): \xff, B\n",
            "line 2: ",
        ),
        (
            b"$timescale 1 us $end\n$var wire 1 ! \xff $end\n",
            "line 2: ",
        ),
    ];
    for (content, line) in cases {
        assert_says(
            &refused(content),
            &[line, "not UTF-8", "save the file as UTF-8"],
        );
    }
}

#[test]
fn sessions_and_binary_exports() {
    assert_says(
        &refused(b"PK\x03\x04\x14\0\0"),
        &["sigrok .sr", "sigrok-cli -i FILE -O vcd"],
    );
    assert_says(
        &refused(b"<SALEAE>\0\0\0\0"),
        &["binary export", "choose CSV"],
    );
    assert_says(
        &refused(vec![0; 200_000]),
        &["line 1: ", "starts with `\\0\\0"],
    );
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for path in [folder.path().join("none.vcd"), folder.path().to_owned()] {
        let error = read(&path, &ChannelSelection::default(), None).expect_err("a refusal");
        assert!(matches!(error.problem, Problem::Unreadable(_)), "{error:?}");
        let start = format!("{}: cannot be read (", path.display());
        assert!(error.to_string().starts_with(&start), "{error}");
        assert_says(&error.to_string(), &["check the path"]);
        assert_eq!(error.line, None);
    }
}
