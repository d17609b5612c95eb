//! Bytes of the firmware's image, by section and by crate, against a golden table.
//!
//! `firmware` is what is flashed; `sized` is the same without the board: link, Modbus, store and tick.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use crate::command::root;
use crate::packages::{AXIS_BOARD, SIZED_BOARD};
use crate::{Result, image};

const GOLDEN: &str = "tests/golden/size.txt";
/// The images: board, program, words that choose it.
const BINS: &[(&str, &str, &[&str])] = &[
    (SIZED_BOARD, "sized", &[]),
    (AXIS_BOARD, "tick_only", &["--features", "tick-only"]),
    (AXIS_BOARD, "firmware", &[]),
];
const SECTIONS: &[&str] = &[
    ".vector_table",
    ".text",
    ".rodata",
    ".data",
    ".bss",
    ".uninit",
    ".ccm",
];
/// Sections that are nothing in the flash.
const IN_RAM_ALONE: &[&str] = &[".bss", ".uninit", ".ccm"];
/// Sections that are something in the RAM; the CCM is another.
const IN_RAM: &[&str] = &[".data", ".bss", ".uninit"];
const HEAD: &str = "\
# Bytes of images in the profile of the firmware: sections, then code by crate. `firmware` is what is flashed to the
# STM32F407, `tick_only` its tick and latches alone, `sized` a firmware without a board's drivers. `flash` is what an image
# takes of the flash, `ram` its statics in the SRAM; beside them are the stack and the CCM.
# Written by `cargo xtask size --bless`; `cargo xtask size` fails on a change of more than 1 % and 64 bytes.
";
/// Crates of less are told together.
const SMALL: u64 = 512;
/// A change of so many bytes is none.
const FEW: u64 = 64;

type Table = BTreeMap<String, u64>;

/// Prints the table; compares it with the golden one, or with `bless` makes it the golden one.
pub fn run(bless: bool) -> Result<()> {
    let mut table = Table::new();
    for (board, bin, words) in BINS {
        image::build(board, bin, words)?;
        let sections = sections(&image::look("llvm-size", &["-A"], bin)?);
        let symbols = image::look("llvm-nm", &["--print-size", "--demangle"], bin)?;
        for (row, bytes) in sections.into_iter().chain(crates(&symbols)) {
            table.insert(format!("{bin}/{row}"), bytes);
        }
    }
    let text = to_text(&table);
    print!("{text}");
    let path = root().join(GOLDEN);
    if bless {
        return fs::write(&path, &text).map_err(|e| format!("{GOLDEN}: {e}"));
    }
    let golden = fs::read_to_string(&path)
        .map_err(|e| format!("{GOLDEN}: {e}; `cargo xtask size --bless` writes it"))?;
    let differences = differences(&table, &from_text(&golden)?);
    if differences.is_empty() {
        return Ok(());
    }
    Err(format!(
        "sizes differ from {GOLDEN}:\n  {}\nexplain the change and run `cargo xtask size --bless`",
        differences.join("\n  ")
    ))
}

/// Sections that take memory, from what `llvm-size -A` prints, and what flash holds.
fn sections(text: &str) -> Table {
    let mut table = Table::new();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        if let (Some(name), Some(Ok(bytes))) = (words.next(), words.next().map(str::parse::<u64>))
            && SECTIONS.contains(&name)
        {
            table.insert(name.to_owned(), bytes);
            if !IN_RAM_ALONE.contains(&name) {
                *table.entry("flash".to_owned()).or_default() += bytes;
            }
            if IN_RAM.contains(&name) {
                *table.entry("ram".to_owned()).or_default() += bytes;
            }
        }
    }
    table
}

/// Code by crate, from what `llvm-nm --print-size --demangle` prints.
fn crates(text: &str) -> Table {
    let mut sums = Table::new();
    for line in text.lines() {
        let mut words = line.splitn(4, ' ');
        let (Some(_), Some(bytes), Some("t" | "T"), Some(name)) =
            (words.next(), words.next(), words.next(), words.next())
        else {
            continue;
        };
        let bytes = u64::from_str_radix(bytes, 16).unwrap_or(0);
        *sums.entry(crate_of(name)).or_default() += bytes;
    }
    let mut table = Table::new();
    for (name, bytes) in sums {
        let name = if bytes < SMALL {
            "others".to_owned()
        } else {
            name
        };
        *table.entry(format!("code/{name}")).or_default() += bytes;
    }
    table
}

/// The crate in `a::b`, `<a::B as c::D>::e` or `_$LT$a..B$GT$::c`; what has none is the compiler's or the runtime's.
fn crate_of(symbol: &str) -> String {
    let plain = symbol.replace("$LT$", "<").replace("..", "::");
    let path = plain.trim_start_matches(['_', '<', '&', '*', '[', '(']);
    match path.split_once("::") {
        Some((name, _))
            if name
                .bytes()
                .all(|byte| byte.is_ascii_alphanumeric() || byte == b'_') =>
        {
            name.to_owned()
        }
        _ => "runtime".to_owned(),
    }
}

fn to_text(table: &Table) -> String {
    let width = table.keys().map(String::len).max().unwrap_or(0);
    let mut text = HEAD.to_owned();
    for (row, bytes) in table {
        text.push_str(&format!("{row:width$} {bytes:>8}\n"));
    }
    text
}

fn from_text(text: &str) -> Result<Table> {
    let lines = text
        .lines()
        .filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    lines
        .map(|line| {
            let (row, bytes) = line.split_once(char::is_whitespace)?;
            Some((row.to_owned(), bytes.trim().parse().ok()?))
        })
        .collect::<Option<_>>()
        .ok_or_else(|| format!("{GOLDEN}: expected a name and its bytes on every line"))
}

/// What is to be explained before `new` may take the place of `old`.
fn differences(new: &Table, old: &Table) -> Vec<String> {
    let rows: BTreeSet<_> = new.keys().chain(old.keys()).collect();
    let change = |row: &&String| {
        let [old, new] = [old, new].map(|table| table.get(*row).copied().unwrap_or(0));
        let by = old.abs_diff(new);
        (by > FEW && by * 100 > old).then(|| format!("{row}: {old} -> {new}"))
    };
    rows.iter().filter_map(change).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const NM: &str = "\
00000100 00000400 t leadscrew::axis::Axis::step::h1
00000500 00000200 T _$LT$leadscrew..axis..Axis$u20$as$u20$core..Clone$GT$::clone::h2
00000700 00000300 t __adddf3
00000a00 00000010 t core::num::small
20000000 00004000 b leadscrew::MEMORY
00000b00 t core::unsized
";

    #[test]
    fn code_is_added_up_by_crate() {
        let expected = [
            ("code/leadscrew", 0x600),
            ("code/others", 0x10),
            ("code/runtime", 0x300),
        ];
        let expected = expected.map(|(name, bytes)| (name.to_owned(), bytes));
        assert_eq!(crates(NM), Table::from(expected));
    }

    #[test]
    fn flash_holds_code_constants_and_first_values() {
        let table = sections("x  :\n.text 1000 72\n.rodata 200 1072\n.data 30 536\n.bss 4 5\n");
        assert_eq!((table["flash"], table["ram"], table[".bss"]), (1230, 34, 4));
    }

    #[test]
    fn a_change_beyond_one_percent_is_told() {
        let table = |bytes| Table::from([("sized/.text".to_owned(), bytes)]);
        assert!(differences(&table(100_900), &table(100_000)).is_empty());
        assert_eq!(differences(&table(101_001), &table(100_000)).len(), 1);
        assert_eq!(differences(&Table::new(), &table(100_000)).len(), 1);
        assert_eq!(from_text(&to_text(&table(5))).unwrap(), table(5));
        assert!(from_text("sized/.text many\n").is_err());
    }
}
