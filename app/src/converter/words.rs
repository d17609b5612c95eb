//! The words of an AD5761R: 24 bits, the high one first.
//!
//! ```text
//! 23 ─ 21   20   19 ─ 16   15 ─────────────────────────── 0
//!   –       0    command   data
//!
//! control register: 10:9 clear voltage, 8 over-range, 7 two's complement, 6 thermal shutdown, 5 internal reference,
//!                   4:3 power-up voltage, 2:0 range; read back also 12 short circuit, 11 brown-out
//! ```
//!
//! From the data sheet, rev. C, tables 10 to 16.

/// Writes the code and puts it out.
const WRITE_AND_UPDATE: u32 = 0x3;
/// Writes the input register, which is not put out.
const WRITE_INPUT: u32 = 0x1;
const WRITE_CONTROL: u32 = 0x4;
const READ_INPUT: u32 = 0xa;
const READ_OUTPUT: u32 = 0xb;
const READ_CONTROL: u32 = 0xc;
const FULL_RESET: u32 = 0xf;

const COMMAND_SHIFT: u32 = 16;
/// Bits 23 to 21 of an answer are not defined.
const ANSWER_MASK: u32 = 0x1f_0000;

/// Midscale, 0 V, where the output is cleared to and powered up to.
const CLEAR_TO_ZERO: u16 = 0b01 << 9;
const POWER_UP_AT_ZERO: u16 = 0b01 << 3;
const THERMAL_SHUTDOWN: u16 = 1 << 6;
const INTERNAL_REFERENCE: u16 = 1 << 5;
/// ±10 V. Over-range stays off: the codes are straight binary from −10 V to +10 V.
const RANGE_10_V: u16 = 0b000;

/// Bits of the control register that are settings.
pub const SETTINGS: u16 = 0x07ff;
/// The output was shorted since the register was written.
pub const SHORT_CIRCUIT: u16 = 1 << 12;
/// The supply fell since the register was written.
pub const BROWN_OUT: u16 = 1 << 11;

/// What an answer holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Register {
    /// The code that is written, but not put out.
    Input,
    /// The code that is put out.
    Output,
    /// Settings and what went wrong.
    Control,
}

impl Register {
    const fn command(self) -> u32 {
        match self {
            Self::Input => READ_INPUT,
            Self::Output => READ_OUTPUT,
            Self::Control => READ_CONTROL,
        }
    }
}

const fn word(command: u32, data: u16) -> u32 {
    command << COMMAND_SHIFT | data as u32
}

/// Puts a code out at once.
#[must_use]
pub const fn put_out(code: u16) -> u32 {
    word(WRITE_AND_UPDATE, code)
}

/// Writes a code without putting it out.
#[must_use]
pub const fn write_input(code: u16) -> u32 {
    word(WRITE_INPUT, code)
}

/// Writes the control register.
#[must_use]
pub const fn write_control(settings: u16) -> u32 {
    word(WRITE_CONTROL, settings)
}

/// Settings: ±10 V, 0 V after power-up and clear, no over-range, off when too hot.
#[must_use]
pub const fn settings(is_reference_internal: bool) -> u16 {
    let reference = if is_reference_internal {
        INTERNAL_REFERENCE
    } else {
        0
    };
    CLEAR_TO_ZERO | POWER_UP_AT_ZERO | THERMAL_SHUTDOWN | RANGE_10_V | reference
}

/// Asks for a register; the answer comes with the next word.
#[must_use]
pub const fn ask(register: Register) -> u32 {
    word(register.command(), 0)
}

/// Back to the state after power-up.
#[must_use]
pub const fn reset() -> u32 {
    word(FULL_RESET, 0)
}

/// What an answer holds of a register that was asked for with the word before; `None` if it is no such answer.
#[must_use]
pub const fn answer(register: Register, answer: u32) -> Option<u16> {
    if answer & ANSWER_MASK == register.command() << COMMAND_SHIFT {
        Some(answer as u16)
    } else {
        None
    }
}
