//! Functions whose addresses are taken: those that a call through a pointer can reach.

use std::collections::{BTreeMap, BTreeSet};

use super::Function;
use super::instruction::{Instruction, immediate};

/// Words of an image that may be addresses.
#[derive(Default)]
pub struct Addresses {
    found: BTreeSet<u32>,
    /// Lower halves that lie in registers.
    halves: BTreeMap<String, u32>,
}

impl Addresses {
    /// Those of constants and initial values.
    pub fn new(data: &[u32]) -> Self {
        Self {
            found: data.iter().copied().collect(),
            halves: BTreeMap::new(),
        }
    }

    /// Those that the code makes of two halves, or has among its instructions.
    pub fn take(&mut self, instruction: &Instruction<'_>) {
        if let Some((_, word)) = instruction.text().split_once(".word") {
            self.found.extend(immediate(word));
        }
        let Some((register, number)) = instruction.operands().split_once(", #") else {
            return;
        };
        let Some(number) = immediate(number) else {
            return;
        };
        match instruction.operation() {
            "movw" => {
                self.halves.insert(register.to_owned(), number);
            }
            "movt" => {
                let lower = self.halves.get(register);
                self.found.extend(lower.map(|lower| number << 16 | lower));
            }
            _ => {}
        }
    }

    /// The functions at them: the lowest bit of the address of a function is set.
    pub fn of(&self, functions: &BTreeMap<u32, Function>) -> BTreeSet<u32> {
        let odd = self.found.iter().filter(|word| **word & 1 == 1);
        odd.map(|word| word - 1)
            .filter(|address| functions.contains_key(address))
            .collect()
    }
}

/// Words of sections as `llvm-objdump -s` prints them: an address, up to four groups of four bytes, and the same as text.
pub fn words(dump: &str) -> Vec<u32> {
    let lines = dump.lines().filter(|line| line.starts_with(' '));
    lines
        .flat_map(|line| {
            let groups = line.split_whitespace().skip(1).take(4);
            // The text behind the last line may look like a group; a word too many does no harm.
            groups.filter_map(|group| {
                let bytes = u32::from_str_radix(group, 16).ok()?;
                (group.len() == 8).then(|| bytes.swap_bytes())
            })
        })
        .collect()
}
