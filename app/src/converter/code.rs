//! Commands to codes of a bipolar 16-bit converter and back.

use leadscrew::units::Command;

/// The code of 0 V.
pub const ZERO: u16 = 0x8000;
/// Bits of a command below the last one of a code.
const FINER_BITS: u32 = Command::FRAC_NBITS - 15;

/// The nearest code; one is 1/32 768 of full command, 0.305 mV. Commands beyond ±1 saturate, and so does +1 itself: the
/// codes end one short of +10 V, at 9.99969 V.
#[inline]
#[must_use]
pub const fn of_command(command: Command) -> u16 {
    let half = 1 << (FINER_BITS - 1);
    let code = (command.to_bits().saturating_add(half) >> FINER_BITS) + ZERO as i32;
    if code < 0 {
        0
    } else if code > u16::MAX as i32 {
        u16::MAX
    } else {
        code as u16
    }
}

/// The command that a code stands for.
#[inline]
#[must_use]
pub const fn to_command(code: u16) -> Command {
    Command::from_bits((code as i32 - ZERO as i32) << FINER_BITS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_comes_back_and_is_the_nearest() {
        for code in 0..=u16::MAX {
            let command = to_command(code);
            assert_eq!(of_command(command), code);
            let bits = command.to_bits();
            let half = 1 << (FINER_BITS - 1);
            assert_eq!(of_command(Command::from_bits(bits - half)), code);
            assert_eq!(of_command(Command::from_bits(bits + half - 1)), code);
        }
    }

    #[test]
    fn zero_is_zero_and_the_ends_saturate() {
        assert_eq!(of_command(Command::ZERO), ZERO);
        assert_eq!(of_command(Command::ONE), u16::MAX);
        assert_eq!(of_command(-Command::ONE), 0);
        assert_eq!(of_command(Command::MAX), u16::MAX);
        assert_eq!(of_command(Command::MIN), 0);
        assert_eq!(to_command(0), -Command::ONE);
    }
}
