//! One line of a disassembly: where it goes and what it takes of the stack.

use std::fmt;

/// An instruction as llvm-objdump prints it.
pub struct Instruction<'t> {
    text: &'t str,
    /// Without its width.
    operation: &'t str,
    operands: &'t str,
}

impl<'t> Instruction<'t> {
    /// What comes behind the address.
    pub fn new(text: &'t str) -> Self {
        let text = text.trim();
        let (operation, operands) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let operation = operation
            .split_once('.')
            .map_or(operation, |(name, _)| name);
        Self {
            text,
            operation,
            operands: operands.trim(),
        }
    }

    pub const fn text(&self) -> &'t str {
        self.text
    }

    pub const fn operation(&self) -> &'t str {
        self.operation
    }

    pub const fn operands(&self) -> &'t str {
        self.operands
    }

    /// The address that it goes to, as `0xbeef <name+0x12> @ imm = #-6`, or as `r0, 0xbeef <name>`.
    pub fn target(&self) -> Option<u32> {
        if !self.is_call() && !self.is_jump() {
            return None;
        }
        let (_, address) = self.operands.split_once("0x")?;
        let end = address.find(|digit: char| !digit.is_ascii_hexdigit());
        u32::from_str_radix(address.get(..end.unwrap_or(address.len()))?, 16).ok()
    }

    /// What the linker fills gaps behind functions with, 0xd4d4, reads as a jump.
    pub fn is_filler(&self) -> bool {
        self.operation == "bmi" && self.operands.ends_with("#-0x58")
    }

    /// Whether it comes back.
    pub fn is_call(&self) -> bool {
        is_with_condition(self.operation, "bl")
    }

    fn is_jump(&self) -> bool {
        is_with_condition(self.operation, "b") || matches!(self.operation, "cbz" | "cbnz")
    }

    pub fn is_trap(&self) -> bool {
        self.operation == "udf"
    }

    /// A jump or a call to what a register or the memory says; a return is none. Tables of a `match` (`tbb`, `tbh`) stay
    /// within their function.
    pub fn is_through_pointer(&self) -> bool {
        let to_pc = self.operands.starts_with("pc,");
        match self.operation {
            // Whatever its condition.
            operation if operation.starts_with("blx") => !self.operands.contains('<'),
            operation if operation.starts_with("bx") => self.operands != "lr",
            // From the stack it is a return.
            operation if operation.starts_with("ldr") => to_pc && !self.operands.contains("[sp]"),
            operation if operation.starts_with("mov") || operation.starts_with("add") => to_pc,
            _ => false,
        }
    }

    /// Bytes by which it lowers the stack pointer; `None` if that cannot be told.
    pub fn pushed(&self) -> Option<u32> {
        match self.operation {
            "push" => Some(4 * registers(self.operands)),
            "vpush" => Some(8 * registers(self.operands)),
            "stmdb" if self.operands.starts_with("sp!") => Some(4 * registers(self.operands)),
            "sub" | "subw" if self.operands.starts_with("sp,") => {
                let number = self.operands.rsplit_once('#').map(|(_, number)| number);
                number.and_then(immediate)
            }
            // str lr, [sp, #-8]!; strd r2, r3, [sp, #-8]!
            "str" | "strd" if self.operands.ends_with("]!") => {
                let number = self.operands.split_once("[sp, #-");
                let number = number.and_then(|(_, number)| number.strip_suffix("]!"));
                Some(number.and_then(immediate).unwrap_or(0))
            }
            // What else writes back to it.
            _ if self.operands.contains("[sp, #-") && self.operands.ends_with("]!") => None,
            "vstmdb" | "mov" | "mov.w" | "bic" | "bic.w" | "and" | "subs"
                if self.operands.starts_with("sp") =>
            {
                None
            }
            _ => Some(0),
        }
    }
}

impl fmt::Display for Instruction<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.operation, self.operands)
    }
}

const CONDITIONS: &[&str] = &[
    "", "eq", "ne", "hs", "lo", "mi", "pl", "vs", "vc", "hi", "ls", "ge", "lt", "gt", "le",
];

fn is_with_condition(operation: &str, name: &str) -> bool {
    let condition = operation.strip_prefix(name);
    condition.is_some_and(|condition| CONDITIONS.contains(&condition))
}

/// A number, as different versions write it: `24` or `0x18`.
pub fn immediate(number: &str) -> Option<u32> {
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
