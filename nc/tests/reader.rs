//! The reader loses nothing: blocks in a row are the file, words and what lies between them are the block.

#[path = "reader/files.rs"]
mod files;

use std::io::BufReader;

use leadscrew_nc::block::{Block, Blocks, FlawKind, Lexis, MAX_BLOCK, OWords, Value, column};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const DECIMAL: Lexis = Lexis {
    round_comments: true,
    semicolon_comments: false,
    expressions: false,
    blanks_in_numbers: false,
    o_words: OWords::ProgramNumber,
};

fn blocks(bytes: &[u8], capacity: usize) -> Vec<Vec<u8>> {
    let mut blocks = Blocks::new(BufReader::with_capacity(capacity, bytes));
    let (mut all, mut block) = (Vec::new(), Vec::new());
    while blocks.next_into(&mut block).unwrap() {
        all.push(block.clone());
    }
    all
}

fn read(text: &[u8], lexis: &Lexis) -> Block {
    let mut block = Block::default();
    block
        .read(text, lexis)
        .unwrap_or_else(|flaw| panic!("{}: {}", column(text, flaw.byte), flaw.what));
    block
}

fn words(text: &str, lexis: &Lexis) -> Vec<String> {
    read(text.as_bytes(), lexis)
        .words
        .iter()
        .map(|word| text[word.span()].to_owned())
        .collect()
}

/// Words lie in a row within the block, and numbers write themselves as they were read.
fn tiles(text: &[u8], block: &Block) {
    let mut end = 0;
    for word in &block.words {
        let span = word.span();
        assert!(span.start >= end && span.end <= block.end && !span.is_empty());
        let letter = text[span.start].to_ascii_uppercase();
        assert!(letter == word.letter || (letter == b':' && word.letter == b'O'));
        end = span.end;
        if let Value::Number(number) = word.value {
            let mut written = Vec::new();
            number.write(&mut written);
            let read: Vec<u8> = text[word.value_span()]
                .iter()
                .copied()
                .filter(|byte| !matches!(byte, b' ' | b'\t'))
                .collect();
            assert_eq!(written, read, "{}", String::from_utf8_lossy(text));
        }
    }
}

#[test]
fn any_line_end_and_none_at_the_end_of_the_file() {
    let text = b"%\r\nN1 G0\rN2\n\n\r\r\nN3";
    let expected: [&[u8]; 7] = [b"%\r\n", b"N1 G0\r", b"N2\n", b"\n", b"\r", b"\r\n", b"N3"];
    for capacity in 1..text.len() + 1 {
        assert_eq!(blocks(text, capacity), expected, "buffer of {capacity}");
    }
}

#[test]
fn a_line_without_end_does_not_fill_the_memory() {
    let long = vec![b'1'; 3 * MAX_BLOCK + 1];
    let read = blocks(&long, 8192);
    assert!(read.iter().all(|block| block.len() <= MAX_BLOCK));
    assert_eq!(read.concat(), long);
}

#[test]
fn words_with_and_without_blanks() {
    let lexis = Lexis::linuxcnc();
    assert_eq!(
        words("N010G01x-1.5Y+2\tZ .5", &lexis),
        ["N010", "G01", "x-1.5", "Y+2", "Z .5"]
    );
    assert_eq!(
        words("g0x +0. 12 34y 7", &lexis),
        ["g0", "x +0. 12 34", "y 7"]
    );
    assert_eq!(
        words("/2 N5 G28 U0 W0", &DECIMAL),
        ["N5", "G28", "U0", "W0"]
    );
    assert_eq!(words("/ G0 X1 (to X2) Z3 ; X4", &lexis), ["G0", "X1", "Z3"]);
    assert_eq!(words("O0001 (PART)", &DECIMAL), ["O0001"]);
    assert_eq!(words("F S1 M3", &lexis), ["F", "S1", "M3"]);
}

#[test]
fn expressions_are_values_that_only_the_control_knows() {
    let lexis = Lexis::linuxcnc();
    let text = "G1 X[#1 + [2*3]] Y#<_depth> Z-#5 A##2 B sin[30] C atan[1]/[2] F#[1+1]";
    assert_eq!(
        words(text, &lexis),
        [
            "G1",
            "X[#1 + [2*3]]",
            "Y#<_depth>",
            "Z-#5",
            "A##2",
            "B sin[30]",
            "C atan[1]/[2]",
            "F#[1+1]"
        ]
    );
    let block = read(text.as_bytes(), &lexis);
    assert!(
        block.words[1..]
            .iter()
            .all(|word| word.value == Value::Expression)
    );
    let block = read(b"#1 = 2.5 #<_z>=[#1*2] G1 X#1", &lexis);
    assert_eq!((block.assignments.len(), block.words.len()), (2, 2));
    let block = read(b"N5 O<drill> call [1] [2] (X1)", &lexis);
    assert_eq!(block.flow, Some(3..29));
}

#[test]
fn a_flaw_is_told_at_its_column() {
    for (text, lexis, at, what) in [
        (
            "N016X4-020500Y+065000",
            DECIMAL,
            5,
            "`X4-020500` is no number",
        ),
        ("G1 X1.2.3", Lexis::linuxcnc(), 4, "`X1.2.3` is no number"),
        (
            "G1 X- Y2",
            DECIMAL,
            4,
            "`X-` is no number: a number needs a digit",
        ),
        (
            "G1 X123456789012345678",
            DECIMAL,
            4,
            "`X123456789012345678` is no number: a number has at most 17 digits",
        ),
        ("G1 X1 ,R2", DECIMAL, 7, "the character `,` begins no word"),
        ("(ä) G1 \u{7}", DECIMAL, 8, "the byte 0x07 begins no word"),
        ("G1 (open", DECIMAL, 4, "the comment is not ended by `)`"),
        (
            "G1 X[1+[2]",
            Lexis::linuxcnc(),
            5,
            "the bracket is not closed",
        ),
        (
            "#1 G1",
            Lexis::linuxcnc(),
            1,
            "a parameter is set like `#1 = 2`",
        ),
        (
            "G1 /X2",
            DECIMAL,
            4,
            "a block delete `/` stands before the first word",
        ),
        ("G1 X#1", DECIMAL, 5, "the character `#` begins no word"),
    ] {
        let flaw = Block::default().read(text.as_bytes(), &lexis).unwrap_err();
        assert_eq!(column(text.as_bytes(), flaw.byte), at, "{text}");
        assert_eq!(flaw.what.to_string(), what, "{text}");
    }
    let flaw = Block::default()
        .read(b"(\xe4\xf6)\xff", &DECIMAL)
        .unwrap_err();
    assert_eq!((flaw.byte, flaw.what), (4, FlawKind::Character(0xff)));
}

#[test]
fn every_program_of_linuxcnc_and_of_our_own_comes_back_whole() {
    let mut flawed = Vec::new();
    for (path, bytes) in files::all() {
        let read = blocks(&bytes, 8192);
        assert_eq!(read.concat(), bytes, "{}", path.display());
        let mut block = Block::default();
        for (number, text) in read.iter().enumerate() {
            match block.read(text, &Lexis::linuxcnc()) {
                Ok(()) => tiles(text, &block),
                // Lines of C that stand for a comment behind the end of a subroutine.
                Err(_) if text.trim_ascii_start().starts_with(b"EMC_ABORT_") => {}
                Err(flaw) => flawed.push(format!(
                    "{}:{}:{}: {}: {}",
                    path.display(),
                    number + 1,
                    column(text, flaw.byte),
                    flaw.what,
                    String::from_utf8_lossy(text).trim_end()
                )),
            }
        }
    }
    assert!(
        flawed.is_empty(),
        "{} flaws:\n{}",
        flawed.len(),
        flawed.join("\n")
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, rng_seed: RngSeed::Fixed(4), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_read_or_refused_and_never_lost(
        bytes in prop_oneof![
            proptest::collection::vec(any::<u8>(), 0..200),
            "[GXYZM0-9.+#\\[\\]()/%; \r\n<>=ox-]{0,120}".prop_map(String::into_bytes),
        ],
        capacity in 1_usize..64,
    ) {
        let read = blocks(&bytes, capacity);
        prop_assert_eq!(read.concat(), bytes);
        let mut block = Block::default();
        for text in &read {
            for lexis in [Lexis::linuxcnc(), DECIMAL] {
                match block.read(text, &lexis) {
                    Ok(()) => tiles(text, &block),
                    Err(flaw) => prop_assert!(flaw.byte < text.len()),
                }
            }
        }
    }
}
