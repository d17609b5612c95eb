//! What is said of files that are wrong: kind of file by flaw. Every message is one line with file, line and column, says what was
//! found and what is expected; the texts stand in the snapshots.

mod kinds;

use std::fmt::Write as _;

use kinds::{CORRECT, PROGRAM, documents, log, setup, tables, texts};

use crate::{Folder, assert_clear, assert_says, text};

/// Characters of a message that is read by a person, whatever the file holds.
const LONGEST: usize = 900;

/// A kind of file, and a command that reads one.
struct Kind {
    file: &'static str,
    command: &'static str,
    good: String,
    /// A word of it that stands once, where a slip is put.
    word: &'static str,
    /// What stands beside it.
    others: Vec<(&'static str, String)>,
}

/// A change of a good file, and what is said of it.
type Flaw = (&'static str, &'static str, &'static [&'static str]);

impl Kind {
    fn new(file: &'static str, command: &'static str, good: String, word: &'static str) -> Self {
        assert_eq!(good.matches(word).count(), 1, "{file}: {word}");
        Self {
            file,
            command,
            good,
            word,
            others: Vec::new(),
        }
    }

    fn beside(mut self, name: &'static str, content: impl Into<String>) -> Self {
        self.others.push((name, content.into()));
        self
    }

    fn folder(&self) -> Folder {
        let folder = Folder::new();
        for (name, content) in &self.others {
            folder.write(name, content);
        }
        folder
    }

    /// What is said of such a file, without what every message begins with.
    #[track_caller]
    fn said(&self, content: &[u8]) -> String {
        let folder = self.folder();
        folder.write(self.file, content);
        let said = folder.refused(1, self.command);
        let said = said.strip_prefix("error: ").unwrap().trim_end();
        assert!(!said.contains(char::is_control), "one line: {said}");
        assert!(said.chars().count() < LONGEST, "{}", said.len());
        let at = said.find(&format!("{}:", self.file)).expect(said);
        let mut place = said[at + self.file.len() + 1..].splitn(3, ':');
        for number in [place.next(), place.next()] {
            let number = number.and_then(|number| number.parse::<usize>().ok());
            assert!(number.is_some_and(|number| number > 0), "a place: {said}");
        }
        said.to_owned()
    }

    #[track_caller]
    fn says(&self, shown: &mut String, flaw: &str, content: &[u8], parts: &[&str]) {
        let said = self.said(content);
        assert_says(&said, parts);
        let _ = writeln!(shown, "{flaw}\n    {said}");
    }

    /// The good file with its word replaced.
    fn with(&self, word: &[u8]) -> Vec<u8> {
        let (before, after) = self.good.split_once(self.word).unwrap();
        [before.as_bytes(), word, after.as_bytes()].concat()
    }

    /// Changes of the good text, each of a stretch that stands once.
    fn slips(&self, shown: &mut String, slips: &[Flaw]) {
        for (from, to, parts) in slips {
            assert_eq!(self.good.matches(from).count(), 1, "{}: {from}", self.file);
            let content = self.good.replace(from, to);
            let flaw = format!("{from:?} is {to:?}");
            self.says(shown, &flaw, content.as_bytes(), parts);
        }
    }
}

fn wide(text: &str, bytes: impl Fn(u16) -> [u8; 2]) -> Vec<u8> {
    let units = std::iter::once(0xFEFF).chain(text.encode_utf16());
    units.flat_map(bytes).collect()
}

#[test]
fn no_file_and_a_directory_are_told() {
    for kind in texts() {
        for directory in [false, true] {
            let folder = kind.folder();
            if directory {
                std::fs::create_dir(folder.path(kind.file)).unwrap();
            }
            let said = folder.refused(1, kind.command);
            assert_says(&said, &[&format!("{}: cannot be read (", kind.file)]);
        }
    }
}

#[test]
fn what_is_no_utf_8_has_its_place() {
    let mut shown = String::new();
    for kind in texts() {
        let comment = [b"# gr\xF6sse\n", kind.good.as_bytes()].concat();
        let file = kind.file;
        let at = |place: &str| format!("{file}:{place}");
        let _ = writeln!(shown, "== {file}");
        for content in [
            wide(&kind.good, u16::to_le_bytes),
            wide(&kind.good, u16::to_be_bytes),
        ] {
            let parts = [&*at("1:1: the file is UTF-16"), "save it"];
            kind.says(&mut shown, "UTF-16", &content, &parts);
        }
        let parts = [&*at("1:5: the byte 0xF6"), "save the file as UTF-8"];
        kind.says(&mut shown, "ISO 8859-1 in a comment", &comment, &parts);
        kind.says(
            &mut shown,
            "ISO 8859-1 in a value",
            &kind.with(b"1\xF6"),
            &["the byte 0xF6"],
        );
        kind.says(&mut shown, "a NUL", &kind.with(b"\0"), &["a NUL"]);
    }
    insta::assert_snapshot!(shown);
}

#[test]
fn the_mark_of_utf_8_changes_nothing() {
    for kind in texts() {
        let folder = kind.folder();
        folder.write(kind.file, &kind.good);
        let plain = folder.run(kind.command);
        assert!(
            plain.status.success(),
            "{}: {}",
            kind.file,
            text(&plain.stderr)
        );
        folder.write(kind.file, format!("\u{feff}{}", kind.good));
        let marked = folder.run(kind.command);
        assert_eq!(text(&marked.stderr), "", "{}", kind.file);
        assert_eq!(text(&marked.stdout), text(&plain.stdout), "{}", kind.file);
    }
}

#[test]
fn tables_that_are_wrong() {
    let mut shown = String::new();
    for kind in tables() {
        let good = &kind.good;
        let _ = writeln!(shown, "== {}", kind.file);
        let mut says = |flaw: &str, content: &str, parts: &[&str]| {
            kind.says(&mut shown, flaw, content.as_bytes(), parts);
        };
        says(
            "empty",
            "",
            &[":1:1: the file is empty: expected the header"],
        );
        let first = good.split(',').next().unwrap();
        let delimiter = format!(":1:{}: ", 1 + first.len());
        says(
            "semicolons",
            &good.replace(',', ";"),
            &[&format!("{delimiter}semicolons part")],
        );
        says(
            "semicolons and decimal commas",
            &good.replace(',', ";").replace('.', ","),
            &[&format!("{delimiter}semicolons part")],
        );
        says(
            "tabs",
            &good.replace(',', "\t"),
            &[&format!("{delimiter}tabs part")],
        );
        let point = |number: &str| good.replace(kind.word, number);
        let comma = kind.word.replace('.', ",");
        let pointed = [kind.word, "decimal point"];
        says(
            "decimal comma",
            &point(&comma),
            &["decimal comma? It is to be a point"],
        );
        says(
            "decimal comma in quotes",
            &point(&format!("\"{comma}\"")),
            &pointed,
        );
        says("NaN", &point("NaN"), &["NaN is out of range"]);
        says("infinite", &point("inf"), &["inf is out of range"]);
        says(
            "no number",
            &point("much"),
            &["= \"much\": expected a number"],
        );
        says(
            "10 MB",
            &point(&"a".repeat(10_000_000)),
            &["expected a number"],
        );
        says(
            "another column",
            &good.replacen(first, "colour", 1),
            &[":1:1: column \"colour\" is not known"],
        );
        says(
            "a slip in a column",
            &good.replacen(first, &format!("{first}s"), 1),
            &[&format!("did you mean {first}?")],
        );
        says(
            "a column twice",
            &good.replacen(first, &format!("{first},{first}"), 1),
            &["is there twice"],
        );
        says(
            "a field too many",
            &good.replacen('\n', "\n1,", 1),
            &[":2:1: ", "and the header has"],
        );
        let rest = &good[first.len() + 1..];
        says(
            "no first column",
            rest,
            &[&format!("there is no column \"{first}\"")],
        );
    }
    insta::assert_snapshot!(shown);
}

#[test]
fn documents_that_are_wrong() {
    let mut shown = String::new();
    for (kind, flaws) in documents() {
        let _ = writeln!(shown, "== {}", kind.file);
        kind.slips(&mut shown, flaws);
        let long = "a".repeat(10_000_000);
        let key = format!("{long} = 1\n{}", kind.good);
        kind.says(
            &mut shown,
            "10 MB of a key",
            key.as_bytes(),
            &[":1:1: unknown field"],
        );
        kind.says(
            &mut shown,
            "10 MB of a value",
            &kind.with(long.as_bytes()),
            &[],
        );
        let tabled = kind.good.replace(" = ", ";");
        kind.says(&mut shown, "no TOML", tabled.as_bytes(), &[":"]);
        let empty = kind.folder();
        empty.write(kind.file, "");
        let output = empty.run(kind.command);
        if !output.status.success() {
            let said = text(&output.stderr);
            assert_clear(&said);
            let _ = writeln!(shown, "empty\n    {}", said.trim_end());
        }
    }
    insta::assert_snapshot!(shown);
}

#[test]
fn logs_that_are_wrong() {
    let kind = log();
    let mut shown = String::new();
    kind.slips(
        &mut shown,
        &[
            (
                "3.0125",
                "3,0125",
                &["log.txt:1:7: `3,0125`", "decimal point, 3.0125"],
            ),
            (
                "3.0125",
                "nan",
                &["log.txt:1:7: `nan`: expected a finite number"],
            ),
            (
                "3.0125 0",
                "3.0125",
                &["log.txt:1:1: 8 numbers: expected 9"],
            ),
            (
                "3.0125 0",
                "3.0125;0",
                &["log.txt:1:7: ", "expected a number"],
            ),
        ],
    );
    kind.says(
        &mut shown,
        "empty",
        b"",
        &["log.txt:1:1: 0 lines for 4 touches"],
    );
    let long = "a".repeat(10_000_000);
    kind.says(
        &mut shown,
        "10 MB",
        &kind.with(long.as_bytes()),
        &["log.txt:1:7:"],
    );
    insta::assert_snapshot!(shown);
}

/// Programs are bytes: what is in their comments is the control's.
#[test]
fn programs_keep_their_bytes_and_are_refused_where_they_are_no_text() {
    let shift = setup("[[terms.affine]]\nname = \"shift\"\nconstant_mm = { X = 0.5 }\n");
    let kind =
        Kind::new("part.ngc", CORRECT, PROGRAM.to_owned(), "over").beside("setup.toml", shift);
    let corrected = |content: &[u8]| {
        let folder = kind.folder();
        folder.write(kind.file, content);
        let output = folder.run(CORRECT);
        assert!(output.status.success(), "{}", text(&output.stderr));
        output.stdout
    };
    let plain = text(&corrected(PROGRAM.as_bytes()));
    assert!(plain.contains("G0 X10.5 Y20 (over)"), "{plain}");
    // ISO 8859-1 and code page 1251.
    for comment in [b"gr\xF6sse".as_slice(), b"\xEE\xF1\xFC"] {
        let (before, after) = plain.split_once("over").unwrap();
        let expected = [before.as_bytes(), comment, after.as_bytes()].concat();
        assert_eq!(corrected(&kind.with(comment)), expected);
    }
    let marked = text(&corrected(format!("\u{feff}{PROGRAM}").as_bytes()));
    assert_eq!(marked, format!("\u{feff}{plain}"));
    assert_eq!(corrected(b""), b"");

    let mut shown = String::new();
    for content in [
        wide(PROGRAM, u16::to_le_bytes),
        wide(PROGRAM, u16::to_be_bytes),
    ] {
        kind.says(
            &mut shown,
            "UTF-16",
            &content,
            &["part.ngc:1:1: the file is UTF-16"],
        );
    }
    let long = "a".repeat(10_000_000);
    // The blocks before it are out.
    let folder = kind.folder();
    for (content, parts) in [
        (
            PROGRAM.replace("over", &long),
            ["part.ngc:2:1: ", "longer than"],
        ),
        (PROGRAM.replace("X10 ", "X1,5 "), ["part.ngc:2:6: ", "`,`"]),
    ] {
        folder.write(kind.file, content);
        let said = folder.refused(1, &format!("{CORRECT} --check"));
        assert_says(&said, &parts);
        let _ = writeln!(shown, "{}", said.trim_end());
    }
    insta::assert_snapshot!(shown);
    for directory in [false, true] {
        let folder = kind.folder();
        if directory {
            std::fs::create_dir(folder.path(kind.file)).unwrap();
        }
        assert_says(&folder.refused(1, CORRECT), &["part.ngc: cannot be read ("]);
    }
}
