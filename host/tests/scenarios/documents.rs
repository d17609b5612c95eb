//! `docs/scenarios.md`: its tables are those that files are read by.

use std::fmt::Write as _;

use leadscrew_host::scenario_file::actions::{ASKED, FOR, Spec, TROUBLES};
use leadscrew_host::scenario_file::expect::{FAULT, FINAL_STATE, LIMITS, PROBED, WARNING};
use leadscrew_host::scenario_file::words::{Key, Value};

use super::root;

/// Lines between which the tables stand.
const BEGIN: &str = "<!-- tables: written by `cargo xtask golden` -->\n";

fn key(key: &Key) -> String {
    let left_out = match key.default {
        Some(default) if default.is_finite() && !matches!(key.value, Value::Word(_)) => {
            format!("; {default} if left out")
        }
        _ => String::new(),
    };
    format!("`{}`: {}, {}{left_out}", key.name, key.what, key.allowed())
}

fn actions(text: &mut String, specs: &[Spec]) -> std::fmt::Result {
    write!(text, "\n| action | | keys |\n| --- | --- | --- |\n")?;
    for Spec {
        name, what, keys, ..
    } in specs
    {
        let keys: Vec<_> = keys.iter().map(key).collect();
        writeln!(text, "| `{name}` | {what} | {} |", keys.join("<br>"))?;
    }
    Ok(())
}

fn tables() -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    write!(text, "\n### What is asked of the axis\n")?;
    actions(&mut text, ASKED)?;
    write!(
        text,
        "\n### What goes wrong\n\nAll of these also have {}.\n",
        key(&FOR)
    )?;
    actions(&mut text, TROUBLES)?;
    write!(
        text,
        "\n## Expectations\n\n| key | unit | |\n| --- | --- | --- |\n"
    )?;
    for limit in LIMITS {
        let Key {
            name, what, value, ..
        } = limit.key;
        let unit = match value {
            Value::Number { unit, .. } => unit,
            _ => "",
        };
        writeln!(text, "| `{name}` | {unit} | {what} |")?;
    }
    for Key { name, what, .. } in [FAULT, WARNING, FINAL_STATE, PROBED] {
        writeln!(text, "| `{name}` | a word | {what} |")?;
    }
    writeln!(text, "\nFaults: {}.", FAULT.allowed())?;
    writeln!(text, "States: {}.", FINAL_STATE.allowed())?;
    Ok(text)
}

#[test]
fn the_page_has_every_action_and_every_expectation() {
    let path = root().join("docs/scenarios.md");
    let page = std::fs::read_to_string(&path).expect("the page is there");
    let (head, found) = page.split_once(BEGIN).expect("the page has its tables");
    let expected = tables().expect("a string takes text");
    if std::env::var_os("INSTA_UPDATE").is_some_and(|update| update == "always") {
        std::fs::write(&path, format!("{head}{BEGIN}{expected}")).expect("the page is written");
    } else {
        assert!(
            found == expected,
            "docs/scenarios.md is not what the code says: run `cargo xtask golden` and review it"
        );
    }
}
