//! The bench image in QEMU, against its golden table.

use std::fs;

use crate::command::{cargo, root};
use crate::golden::Table;
use crate::{Result, packages};

const GOLDEN: &str = "tests/golden/bench.txt";
/// 1 µs an instruction: SysTick then counts single instructions exactly.
const SHIFT: &str = "10";

/// Prints the table; compares it with the golden one, or with `bless` makes it the golden one.
pub fn run(bless: bool) -> Result<()> {
    let log = cargo(["run", "--quiet", "--package", packages::QEMU, "--"])
        .words(&["bench", "--messages", "--shift", SHIFT])
        .words(&[&format!("shift={SHIFT}")])
        .output()?;
    let table = Table::from_log(&(log + &sizes()?))?;
    let text = table.to_text();
    print!("{text}");
    let path = root().join(GOLDEN);
    if bless {
        return fs::write(&path, &text).map_err(|e| format!("{GOLDEN}: {e}"));
    }
    let golden = fs::read_to_string(&path)
        .map_err(|e| format!("{GOLDEN}: {e}; `cargo xtask bench --bless` writes it"))?;
    let differences = table.differences(&Table::from_file(&golden)?);
    if differences.is_empty() {
        return Ok(());
    }
    Err(format!(
        "instruction counts differ from {GOLDEN}:\n  {}\n\
         explain the change and run `cargo xtask bench --bless`",
        differences.join("\n  ")
    ))
}

/// Bytes of the product core's image as rows of the table: what the product takes without simulator and
/// log.
fn sizes() -> Result<String> {
    let sections = cargo(["run", "--quiet", "--package", packages::QEMU, "--"])
        .words(&["product", "--sections"])
        .output()?;
    let row = |line: &str| {
        let (section, bytes) = line.split_once(' ')?;
        Some(format!("bench product/{section}_bytes {bytes} {bytes} 1\n"))
    };
    Ok(sections.lines().filter_map(row).collect())
}
