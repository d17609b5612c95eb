//! The calls of an image, from its disassembly by llvm-objdump.

mod instruction;
mod pointers;
mod walk;

#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};

use crate::Result;
use instruction::Instruction;
pub use pointers::words;
pub use walk::{Rules, Through, Tree};

/// Functions of an image by their addresses, and what each does.
pub struct Calls {
    functions: BTreeMap<u32, Function>,
    /// Functions whose addresses lie somewhere: what a call through a pointer can reach.
    taken: BTreeSet<u32>,
}

#[derive(Debug, Default, PartialEq, Eq)]
struct Function {
    name: String,
    /// Addresses that it calls, and comes back from.
    calls: BTreeSet<u32>,
    /// Addresses that it goes to, in itself or in another function.
    jumps: BTreeSet<u32>,
    /// Instructions that trap.
    traps: Vec<String>,
    /// Instructions that go where a register says.
    through_pointers: Vec<String>,
    /// Instructions that take an unknown piece of stack.
    unknown_stack: Vec<String>,
    /// Bytes that it puts on the stack, as far as its instructions tell.
    stack: u32,
}

impl Calls {
    /// Reads the output of `llvm-objdump -d --no-show-raw-insn`; `data`: the [`words`] of constants and initial values.
    pub fn read(text: &str, data: &[u32]) -> Result<Self> {
        let mut functions = BTreeMap::new();
        let mut addresses = pointers::Addresses::new(data);
        let mut start = None;
        let mut lines = text.lines().peekable();
        while let Some(line) = lines.next() {
            if let Some((address, name)) = head(line) {
                // Marks of code and data begin no function.
                if !name.starts_with('$') {
                    let function = Function {
                        name: plain(name),
                        ..Function::default()
                    };
                    functions.entry(address).or_insert(function);
                    start = Some(address);
                }
            } else if let Some(start) = start
                && let Some((_, text)) = line.split_once(':')
                && let Some(function) = functions.get_mut(&start)
            {
                let instruction = Instruction::new(text);
                let is_last = lines.peek().is_none_or(|line| line.is_empty());
                if is_last && instruction.is_filler() {
                    continue;
                }
                addresses.take(&instruction);
                function.take(&instruction);
            }
        }
        if functions.is_empty() {
            return Err("the disassembly has no function".to_owned());
        }
        let taken = addresses.of(&functions);
        Ok(Self { functions, taken })
    }

    /// The functions at which handlers begin: entries of the vector table but the first two (stack, reset) and the default
    /// one, which most entries are.
    pub fn handlers(&self, vectors: &[u32]) -> Vec<&str> {
        let entries: Vec<u32> = vectors.iter().skip(2).map(|entry| entry & !1).collect();
        let times = |address: u32| entries.iter().filter(|entry| **entry == address).count();
        let usual = entries.iter().copied().filter(|entry| *entry != 0);
        let default = usual.max_by_key(|entry| times(*entry));
        let own: BTreeSet<_> = entries.into_iter().collect();
        let own = own.into_iter().filter(|entry| Some(*entry) != default);
        own.filter_map(|entry| self.functions.get(&entry))
            .map(|function| function.name.as_str())
            .collect()
    }

    /// Start of the function around `address`.
    fn around(&self, address: u32) -> Option<(u32, &Function)> {
        let (start, function) = self.functions.range(..=address).next_back()?;
        Some((*start, function))
    }
}

impl Function {
    fn take(&mut self, instruction: &Instruction<'_>) {
        match instruction.pushed() {
            Some(bytes) => self.stack += bytes,
            None => self.unknown_stack.push(instruction.to_string()),
        }
        if instruction.is_trap() {
            self.traps.push(instruction.to_string());
        }
        if instruction.is_through_pointer() {
            self.through_pointers.push(instruction.to_string());
        }
        if let Some(target) = instruction.target() {
            if instruction.is_call() {
                self.calls.insert(target);
            } else {
                self.jumps.insert(target);
            }
        }
    }
}

/// Address and name of `0000beef <name>:`.
fn head(line: &str) -> Option<(u32, &str)> {
    let (address, name) = line.split_once(" <")?;
    let address = u32::from_str_radix(address, 16).ok()?;
    Some((address, name.strip_suffix(">:")?))
}

/// A name as it is in the source: without the escapes of its mangling and without its hash.
fn plain(name: &str) -> String {
    let escapes = [
        ("$LT$", "<"),
        ("$GT$", ">"),
        ("$u20$", " "),
        ("_$u7b$", "{"),
        ("$u7b$", "{"),
        ("$u7d$", "}"),
        ("$RF$", "&"),
        ("$C$", ","),
        ("$u5b$", "["),
        ("$u5d$", "]"),
        ("..", "::"),
    ];
    let mut text = name
        .strip_prefix("_$")
        .map_or(name.to_owned(), |rest| format!("${rest}"));
    for (escape, plain) in escapes {
        text = text.replace(escape, plain);
    }
    match text.rsplit_once("::h") {
        Some((path, hash)) if hash.len() == 16 && hash.bytes().all(|b| b.is_ascii_hexdigit()) => {
            path.to_owned()
        }
        _ => text,
    }
}
