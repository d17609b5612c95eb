//! The calls of an image, from its disassembly by llvm-objdump.

use std::collections::{BTreeMap, BTreeSet};

use crate::Result;

/// What panics, by what its names have in common; `udf` is an instruction that traps.
const PANICS: &[&str] = &[
    "panicking",
    "unwrap_failed",
    "expect_failed",
    "rust_begin_unwind",
];

/// Functions of an image by their addresses, and what each does.
pub struct Calls(BTreeMap<u32, Function>);

#[derive(Debug, Default, PartialEq, Eq)]
struct Function {
    name: String,
    /// Addresses in other functions, or in this one.
    calls: BTreeSet<u32>,
    /// Instructions that may not be.
    faults: Vec<String>,
    /// Bytes that it puts on the stack, as far as its instructions tell.
    stack: u32,
}

/// What can be reached from a function.
#[derive(Debug, PartialEq, Eq)]
pub struct Tree {
    pub functions: usize,
    pub faults: Vec<String>,
    /// Bytes of the deepest way.
    pub stack: u32,
}

impl Calls {
    /// Reads the output of `llvm-objdump -d --no-show-raw-insn`.
    pub fn read(text: &str) -> Result<Self> {
        let mut functions = BTreeMap::new();
        let mut start = None;
        for line in text.lines() {
            if let Some((address, name)) = head(line) {
                // Marks of code and data begin no function.
                if !name.starts_with('$') {
                    let name = name.to_owned();
                    let function = Function {
                        name,
                        ..Function::default()
                    };
                    functions.entry(address).or_insert(function);
                    start = Some(address);
                }
            } else if let Some(start) = start
                && let Some((_, instruction)) = line.split_once(':')
                && let Some(function) = functions.get_mut(&start)
            {
                function.take(instruction);
            }
        }
        if functions.is_empty() {
            return Err("the disassembly has no function".to_owned());
        }
        Ok(Self(functions))
    }

    /// All that `root` can call. Functions of `allowed`, by how their names begin, may call through pointers.
    ///
    /// # Errors
    /// There is no such function.
    pub fn reachable_from(&self, root: &str, allowed: &[(&str, &str)]) -> Result<Tree> {
        let named = self.0.iter().find(|(_, function)| function.name == root);
        let (&start, _) = named.ok_or_else(|| format!("the image has no function {root}"))?;
        let mut walk = Walk {
            calls: self,
            allowed,
            done: BTreeMap::new(),
            way: Vec::new(),
            faults: Vec::new(),
        };
        let stack = walk.visit(start);
        Ok(Tree {
            functions: walk.done.len(),
            faults: walk.faults,
            stack,
        })
    }
}

struct Walk<'c> {
    calls: &'c Calls,
    allowed: &'c [(&'c str, &'c str)],
    /// Stack of the functions that are done with, by their addresses.
    done: BTreeMap<u32, u32>,
    way: Vec<&'c str>,
    faults: Vec<String>,
}

impl<'c> Walk<'c> {
    /// Stack of the function around `address` and all below it, bytes.
    fn visit(&mut self, address: u32) -> u32 {
        let Some((&start, function)) = self.calls.0.range(..=address).next_back() else {
            self.faults
                .push(format!("{address:#x}: called, and no function is there"));
            return 0;
        };
        let name = function.name.as_str();
        if let Some(stack) = self.done.get(&start) {
            return *stack;
        }
        if self.way.contains(&name) {
            self.faults.push(format!(
                "{name}: calls itself, so that its stack has no bound"
            ));
            return 0;
        }
        if PANICS.iter().any(|panic| name.contains(panic)) {
            self.faults
                .push(format!("{name}: reached by {}", self.way.join(" > ")));
        }
        let is_allowed = self
            .allowed
            .iter()
            .any(|(begin, _)| name.starts_with(begin));
        let faults = function.faults.iter();
        let faults = faults.filter(|fault| !(is_allowed && fault.starts_with("blx")));
        self.faults
            .extend(faults.map(|fault| format!("{name}: {fault}")));
        self.way.push(name);
        let inside = self
            .calls
            .0
            .range(start + 1..)
            .next()
            .map(|(next, _)| start..*next);
        let inside = inside.unwrap_or(start..u32::MAX);
        let outside = function
            .calls
            .iter()
            .filter(|callee| !inside.contains(callee));
        let below = outside.map(|callee| self.visit(*callee)).max();
        self.way.pop();
        let stack = function.stack + below.unwrap_or(0);
        self.done.insert(start, stack);
        stack
    }
}

impl Function {
    fn take(&mut self, instruction: &str) {
        let instruction = instruction.trim();
        let (operation, operands) = instruction
            .split_once(char::is_whitespace)
            .unwrap_or((instruction, ""));
        let operands = operands.trim();
        self.stack += pushed(operation, operands);
        if is_forbidden(operation, operands) {
            self.faults.push(format!("{operation} {operands}"));
        }
        if is_branch(operation)
            && let Some(target) = target(operands)
        {
            self.calls.insert(target);
        }
    }
}

/// Address and name of `0000beef <name>:`.
fn head(line: &str) -> Option<(u32, &str)> {
    let (address, name) = line.split_once(" <")?;
    let address = u32::from_str_radix(address, 16).ok()?;
    Some((address, name.strip_suffix(">:")?))
}

/// The address in `0xbeef <name+0x12> @ imm = #-6`, or in `r0, 0xbeef <name>`.
fn target(operands: &str) -> Option<u32> {
    let (_, address) = operands.split_once("0x")?;
    let end = address.find(|digit: char| !digit.is_ascii_hexdigit());
    u32::from_str_radix(address.get(..end.unwrap_or(address.len()))?, 16).ok()
}

/// The operation without its width.
fn narrow(operation: &str) -> &str {
    operation
        .split_once('.')
        .map_or(operation, |(name, _)| name)
}

const CONDITIONS: &[&str] = &[
    "eq", "ne", "hs", "lo", "mi", "pl", "vs", "vc", "hi", "ls", "ge", "lt", "gt", "le",
];

fn is_branch(operation: &str) -> bool {
    let operation = narrow(operation);
    let is_conditional = operation
        .strip_prefix('b')
        .is_some_and(|condition| CONDITIONS.contains(&condition));
    is_conditional || matches!(operation, "b" | "bl" | "cbz" | "cbnz")
}

/// A trap, or a jump to what a register or the memory says; a return is none. Tables of a `match` (`tbb`, `tbh`) stay
/// within their function.
fn is_forbidden(operation: &str, operands: &str) -> bool {
    let operation = narrow(operation);
    let to_pc = operands.starts_with("pc,");
    match operation {
        "udf" => true,
        // Whatever its condition.
        _ if operation.starts_with("blx") => !operands.contains('<'),
        _ if operation.starts_with("bx") => operands != "lr",
        // From the stack it is a return.
        _ if operation.starts_with("ldr") => to_pc && !operands.contains("[sp]"),
        _ if operation.starts_with("mov") || operation.starts_with("add") => to_pc,
        _ => false,
    }
}

/// Bytes by which an instruction lowers the stack pointer.
fn pushed(operation: &str, operands: &str) -> u32 {
    match narrow(operation) {
        "push" => 4 * registers(operands),
        "vpush" => 8 * registers(operands),
        "stmdb" if operands.starts_with("sp!") => 4 * registers(operands),
        "sub" | "subw" if operands.starts_with("sp") => {
            let number = operands.rsplit_once('#').map(|(_, number)| number);
            number.and_then(immediate).unwrap_or(0)
        }
        // str lr, [sp, #-8]!
        "str" if operands.ends_with("]!") => {
            let number = operands.split_once("[sp, #-").map(|(_, number)| number);
            let number = number.and_then(|number| number.strip_suffix("]!"));
            number.and_then(immediate).unwrap_or(0)
        }
        _ => 0,
    }
}

/// A number, as different versions write it: `24` or `0x18`.
fn immediate(number: &str) -> Option<u32> {
    let number = number.trim();
    match number.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => number.parse().ok(),
    }
}

/// Registers of `{r4, r5, d8-d11}`.
fn registers(operands: &str) -> u32 {
    let list = operands.split_once('{').map_or("", |(_, list)| list);
    let list = list.trim_end_matches('}');
    let number = |name: &str| name.trim().get(1..).and_then(|n| n.parse::<u32>().ok());
    list.split(',')
        .map(|part| match part.split_once('-') {
            Some((first, last)) => match (number(first), number(last)) {
                (Some(first), Some(last)) => last.saturating_sub(first) + 1,
                _ => 1,
            },
            None => 1,
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "\
00000100 <tick>:
     100:      \tpush.w\t{r4, r5, r6, lr}
     104:      \tsub\tsp, #0x18
     106:      \tbl\t0x200 <work> @ imm = #246
     10a:      \tb.w\t0x300 <core::fmt::x<T>+0x4> @ imm = #246
00000200 <work>:
     200:      \tbeq\t0x204 <work+0x4> @ imm = #0
     204:      \tvpush\t{d8, d9}
     206:      \tbx\tlr
00000300 <core::fmt::x<T>>:
     300:      \tldr\tpc, [sp], #8
00000400 <core::panicking::panic>:
     400:      \tudf\t#254
";

    fn tree(text: &str) -> Tree {
        Calls::read(text)
            .unwrap()
            .reachable_from("tick", &[])
            .unwrap()
    }

    #[test]
    fn what_is_not_reached_is_no_fault() {
        let expected = Tree {
            functions: 3,
            faults: Vec::new(),
            stack: 16 + 24 + 16,
        };
        assert_eq!(tree(GOOD), expected);
    }

    #[test]
    fn planted_faults_are_found() {
        for planted in [
            "     208:      \tbl\t0x400 <core::panicking::panic> @ imm = #1",
            "     208:      \tbeq.w\t0x400 <core::panicking::panic> @ imm = #1",
            "     208:      \tudf\t#254",
            "     208:      \tblx\tr3",
            "     208:      \tbx\tr3",
            "     208:      \tldr.w\tpc, [r0, r1, lsl #2]",
            "     208:      \tmov\tpc, r3",
            "     208:      \tbl\t0x100 <tick> @ imm = #1",
            "     208:      \tbl\t0x20 <before> @ imm = #1",
        ] {
            let text = GOOD.replace("     206:", &format!("{planted}\n     206:"));
            assert!(!tree(&text).faults.is_empty(), "{planted}");
        }
    }

    #[test]
    fn who_is_allowed_may_call_through_pointers_and_not_trap() {
        let faults = |planted: &str| {
            let text = GOOD.replace(
                "     206:",
                &format!("     208:      \t{planted}\n     206:"),
            );
            let calls = Calls::read(&text).unwrap();
            let tree = calls.reachable_from("tick", &[("work", "a table")]);
            tree.unwrap().faults.len()
        };
        assert_eq!(faults("blx\tr3"), 0);
        assert_eq!(faults("udf\t#254"), 1);
    }

    #[test]
    fn an_image_without_the_tick_is_an_error() {
        let text = GOOD.replace("<tick>:", "<tock>:");
        assert!(
            Calls::read(&text)
                .unwrap()
                .reachable_from("tick", &[])
                .is_err()
        );
        assert!(Calls::read("").is_err());
    }
}
