//! `docs/modbus.md`: its tables are what the code says. `cargo xtask golden` writes them anew.

use std::fmt::Write as _;

use leadscrew::settings::{Key, Number, Values};
use leadscrew_app::modbus::bits::{BITS, FAULTS, NUMBERS, STATUS, WARNINGS};
use leadscrew_app::modbus::map::{
    BLOCK, DEFAULTS, MAXIMA, MINIMA, SAVE, SAVE_KEY, VALUES, WORDS_PER_PARAMETER,
};
use leadscrew_app::modbus::registers::REGISTERS;

use crate::fake::settings;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/modbus.md");

/// Name, unit, and the words that it may be.
type Parameter = (String, &'static str, Vec<&'static str>);

#[derive(Default)]
struct Names(Vec<Parameter>);

impl Values for Names {
    fn number(&mut self, key: Key, number: &Number, value: f64) -> f64 {
        self.0.push((key.to_string(), number.unit, Vec::new()));
        value
    }

    fn word(&mut self, key: Key, words: &[&'static str], value: &'static str) -> &'static str {
        self.0.push((key.to_string(), "", words.to_vec()));
        value
    }
}

fn parameters() -> Vec<Parameter> {
    let mut names = Names::default();
    settings().visit(&mut names);
    names.0
}

/// Names of all parameters, in the order of the link.
pub fn names() -> Vec<String> {
    parameters().into_iter().map(|(name, ..)| name).collect()
}

/// CRC-32 of the names, bit by bit.
pub fn list_checksum() -> u32 {
    let lines = parameters().into_iter().map(|(name, _, words)| {
        let words = words.into_iter().map(|word| format!(" {word}"));
        format!("{name}{}\n", words.collect::<String>())
    });
    let text: String = lines.collect();
    let crc = text.bytes().fold(!0, |crc: u32, byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            crc >> 1 ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 }
        })
    });
    !crc
}

fn registers() -> String {
    let mut text =
        String::from("| address | name | type | unit | |\n| --- | --- | --- | --- | --- |\n");
    for register in REGISTERS {
        let first = register.address;
        let address = match register.count {
            1 => format!("{first}"),
            count => format!("{first} to {}", first + count - 1),
        };
        let (name, kind, unit, what) = (register.name, register.kind, register.unit, register.what);
        let _ = writeln!(text, "| {address} | `{name}` | {kind} | {unit} | {what} |");
    }
    text
}

fn bits() -> String {
    let mut text = String::from("| input | name | on while |\n| --- | --- | --- |\n");
    for bit in BITS {
        let _ = writeln!(text, "| {} | `{}` | {} |", bit.number, bit.name, bit.what);
    }
    let (from, to) = (BITS.len(), STATUS - 1);
    let _ = writeln!(text, "| {from} to {to} | | Off. |");
    let block = |first: u16| format!("{first} to {}", first + NUMBERS - 1);
    let (faults, warnings) = (block(FAULTS), block(WARNINGS));
    let _ = writeln!(
        text,
        "| {faults} | {FAULTS} + n | The fault of number n is latched. |"
    );
    let _ = writeln!(
        text,
        "| {warnings} | {WARNINGS} + n | The warning of number n stands. |"
    );
    text
}

fn blocks() -> String {
    let size = WORDS_PER_PARAMETER;
    let mut text = String::from("| address | | function |\n| --- | --- | --- |\n");
    let _ = writeln!(
        text,
        "| {VALUES} + {size} n | value of parameter n | 3, 4, 16 |"
    );
    for (base, what) in [
        (MINIMA, "smallest value allowed"),
        (MAXIMA, "largest value allowed"),
        (DEFAULTS, "what it is if nobody sets it"),
    ] {
        let _ = writeln!(text, "| {base} + {size} n | {what} | 3, 4 |");
    }
    let _ = writeln!(
        text,
        "| {SAVE} | save: write {SAVE_KEY} (0x{SAVE_KEY:X}); reads as 0 | 3, 4, 6, 16 |"
    );
    text
}

fn parameter_table() -> String {
    let mut text = format!(
        "`parameter_count` is {}, `parameter_list` 0x{:08X}.\n\n",
        names().len(),
        list_checksum()
    );
    text.push_str("| n | value | parameter | unit, or words |\n| --- | --- | --- | --- |\n");
    for (index, (name, unit, words)) in parameters().iter().enumerate() {
        let address = usize::from(VALUES) + index * usize::from(WORDS_PER_PARAMETER);
        let words = words.iter().enumerate();
        let words: Vec<_> = words.map(|(at, word)| format!("{at} {word}")).collect();
        let words = words.join(", ");
        let _ = writeln!(text, "| {index} | {address} | `{name}` | {unit}{words} |");
    }
    text
}

/// `page` with what is between the marks of `name` replaced.
fn with(page: &str, name: &str, text: &str) -> String {
    let mark = format!("<!-- made: {name} -->\n");
    let (before, rest) = page.split_once(&mark).expect("the page has the mark");
    let (_, after) = rest.split_once("<!-- end -->").expect("it has an end");
    format!("{before}{mark}{text}<!-- end -->{after}")
}

#[test]
fn the_tables_of_the_page_are_what_the_code_says() {
    let found = std::fs::read_to_string(PAGE).unwrap();
    let made = [
        ("registers", registers()),
        ("bits", bits()),
        ("blocks", blocks()),
        ("parameters", parameter_table()),
        ("mb2hal", format!("```ini\n{}```\n", crate::masters::MB2HAL)),
    ];
    let text = made
        .iter()
        .fold(found.clone(), |page, (name, text)| with(&page, name, text));
    if std::env::var_os("INSTA_UPDATE").is_some_and(|update| update == "always") {
        std::fs::write(PAGE, &text).unwrap();
        return;
    }
    assert!(
        found == text,
        "docs/modbus.md is not what the code says: run `cargo xtask golden` and review it"
    );
}

#[test]
fn there_is_room_for_the_parameters() {
    assert!(names().len() <= usize::from(BLOCK / WORDS_PER_PARAMETER));
}
