//! The output converter, an AD5761R: 16 bits, ±10 V, on SPI.
//!
//! ```text
//! tick k     put out code k    ask for output    ask for control
//! answers    control of k−1    –                 output of k
//! ```
//!
//! Three words a tick put the command out and bring back what the converter then holds and, one tick later, its settings: 72
//! clocks, 7 µs at 10.5 MHz. The supervisor compares what came back with the command (`OutputMismatch`). A converter that
//! does not answer, lost its settings, is shorted or had no supply does not put out what its register says; it is given to
//! the supervisor as the full command against the one that was told, which is a mismatch whatever the tolerance.
//!
//! Before that the wires are tried by the input register, with /LDAC high: low, it would put every pattern out. It stays high, as
//! the tick's word puts out what it brings whatever /LDAC is. [`Upkeep`] sets a converter that failed up anew.
//!
//! To be verified with a board: the time after a reset and for the internal reference to settle, which the board waits; that
//! the output stays at 0 V from power-up to the first code; SDO valid at the board's SPI clock.

mod code;
mod trial;
mod upkeep;
mod words;

pub use code::{ZERO, of_command, to_command};
pub use upkeep::{TRIES, Upkeep};
pub use words::{Register, put_out};

use core::fmt;

use leadscrew::units::Command;
use trial::Trial;

/// Puts 0 V out, whatever was before: for the handlers of panics and hard faults.
pub const PUT_OUT_ZERO: u32 = put_out(ZERO);

/// The SPI that the converter is on.
pub trait Bus {
    /// Sends a word of 24 bits, the high one first, with /SYNC low meanwhile, and gives what came back; `None` if that did not
    /// end in its bounded time.
    fn exchange(&mut self, word: u32) -> Option<u32>;
    /// Drives /RESET: held, the output is clamped to ground.
    fn hold_reset(&mut self, is_held: bool);
}

/// What is wrong with the converter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Trouble {
    /// The SPI did not end, or what came back is no answer.
    Silent,
    /// Bits come back other than they were sent.
    Garbled {
        /// What was sent.
        sent: u16,
        /// What came back.
        seen: u16,
    },
    /// The control register is not what was written: the range may be another.
    Settings {
        /// What came back.
        seen: u16,
    },
    /// The output is shorted.
    ShortCircuit,
    /// The supply fell.
    BrownOut,
    /// The alert line is active: too hot, shorted, or fresh from a reset.
    Alert,
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Silent => {
                f.write_str("the output converter does not answer: check its supply and the SPI")
            }
            Self::Garbled { sent, seen } => write!(
                f,
                "the output converter was sent {sent:#06x} and holds {seen:#06x}: check the SPI's wires"
            ),
            Self::Settings { seen } => write!(
                f,
                "the output converter lost its settings ({seen:#06x}): check its supply, then switch off and on"
            ),
            Self::ShortCircuit => {
                f.write_str("the command's output is shorted: check the wires to the drive")
            }
            Self::BrownOut => {
                f.write_str("the output converter's supply fell: check it, then switch off and on")
            }
            Self::Alert => f.write_str(
                "the output converter gives alert: it is too hot or shorted; check the wires to the drive",
            ),
        }
    }
}

/// What became of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Put {
    /// For the supervisor: what is put out, as far as the converter says.
    pub readback: Command,
    /// Why that is not to be believed.
    pub trouble: Option<Trouble>,
}

/// The converter, as it was set up.
#[derive(Clone, Debug)]
pub struct Converter {
    settings: u16,
    /// The last word asked for the control register.
    has_asked: bool,
}

impl Converter {
    /// Resets it: the output goes to 0 V. Then the board waits until it is up, and calls [`Self::start`].
    ///
    /// # Errors
    /// The SPI did not end.
    pub fn reset(bus: &mut impl Bus) -> Result<(), Trouble> {
        bus.exchange(words::reset())
            .map(|_| ())
            .ok_or(Trouble::Silent)
    }

    /// Sets it up at 0 V and checks wires, range and settings by reading them back.
    ///
    /// # Errors
    /// What is wrong with it; no axis is to be enabled then.
    pub fn start(bus: &mut impl Bus, is_reference_internal: bool) -> Result<Self, Trouble> {
        let mut trial = Trial::new(is_reference_internal);
        loop {
            if let Some(converter) = trial.step(bus)? {
                return Ok(converter);
            }
        }
    }

    /// Puts a command out and says what the converter then holds. `is_alert`: its alert line is active. Three words, bounded
    /// by the bus.
    pub fn put(&mut self, bus: &mut impl Bus, command: Command, is_alert: bool) -> Put {
        let code = of_command(command);
        let control = bus.exchange(put_out(code));
        let asked = bus.exchange(words::ask(Register::Output));
        let output = bus.exchange(words::ask(Register::Control));
        let is_control_due = core::mem::replace(&mut self.has_asked, output.is_some());

        let seen = output.and_then(|word| words::answer(Register::Output, word));
        let trouble = match (seen, control, asked) {
            (Some(_), Some(_), Some(_)) if is_alert => Some(Trouble::Alert),
            (Some(_), Some(control), Some(_)) if is_control_due => self.judge(control),
            (Some(_), Some(_), Some(_)) => None,
            _ => Some(Trouble::Silent),
        };
        Put {
            readback: match seen {
                Some(seen) if trouble.is_none() => to_command(seen),
                _ => opposite(command),
            },
            trouble,
        }
    }

    /// What the control register tells.
    const fn judge(&self, word: u32) -> Option<Trouble> {
        let Some(seen) = words::answer(Register::Control, word) else {
            return Some(Trouble::Silent);
        };
        // A brown-out loses the settings, and says more.
        if seen & words::BROWN_OUT != 0 {
            Some(Trouble::BrownOut)
        } else if seen & words::SHORT_CIRCUIT != 0 {
            Some(Trouble::ShortCircuit)
        } else if seen & words::SETTINGS != self.settings {
            Some(Trouble::Settings { seen })
        } else {
            None
        }
    }
}

/// The full command that a command is not.
fn opposite(command: Command) -> Command {
    if command.is_negative() {
        Command::ONE
    } else {
        -Command::ONE
    }
}
