//! `docs/scope.md`: its table of signals is what the code says.

use std::fmt::Write as _;

use leadscrew::scope::{MOST_INTERRUPTIONS, MOST_SIGNALS, Signal};

use crate::{reviewed, with};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/scope.md");

fn signals() -> String {
    let mut text = String::from(
        "| number | signal | unit | fractional bits | sample | |\n| --- | --- | --- | --- | --- | --- |\n",
    );
    for signal in Signal::ALL {
        let about = signal.description();
        let (unit, kind) = (about.unit.text(), about.kind.text());
        let (number, frac, what) = (*signal as u8, about.frac, about.what);
        let _ = writeln!(
            text,
            "| {number} | `{signal}` | {unit} | {frac} | {kind} | {what} |"
        );
    }
    text
}

#[test]
fn the_table_of_signals_is_what_the_code_says() {
    let page = std::fs::read_to_string(PAGE).unwrap();
    reviewed("scope.md", &with(&page, "signals", &signals()));
}

#[test]
fn the_numbers_of_the_page_are_those_of_the_code() {
    let page = std::fs::read_to_string(PAGE).unwrap();
    assert!(page.contains(&format!("Up to {MOST_SIGNALS} signals")));
    assert!(page.contains(&format!("it keeps {MOST_INTERRUPTIONS};")));
}
