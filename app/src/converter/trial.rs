//! Setting a converter up, a few words at a time: a tick has no time for all of them.

use super::words::{self, Register};
use super::{Bus, Converter, Trouble};
use leadscrew::units::Command;

/// What the wires are tried with: every bit once high and once low, and neighbours unlike. The last one is 0 V: should the input
/// register be put out by whatever, that is what comes.
const PATTERNS: [u16; 4] = [0x5555, 0xaaaa, 0x00ff, super::ZERO];

/// How far it is.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    converter: Converter,
    step: usize,
}

impl Trial {
    /// Of a converter that is up after its reset.
    pub const fn new(is_reference_internal: bool) -> Self {
        Self {
            converter: Converter {
                settings: words::settings(is_reference_internal),
                has_asked: true,
            },
            step: 0,
        }
    }

    /// The next three words at most; the converter after the last ones.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn step(&mut self, bus: &mut impl Bus) -> Result<Option<Converter>, Trouble> {
        let step = self.step;
        self.step = step.saturating_add(1);
        if step == 0 {
            // The control register ends the clamp to ground: 0 V is to be behind it, also in a converter that does not load its
            // power-up voltage.
            for word in [
                super::PUT_OUT_ZERO,
                words::write_control(self.converter.settings),
            ] {
                bus.exchange(word).ok_or(Trouble::Silent)?;
            }
            return Ok(None);
        }
        if let Some(pattern) = PATTERNS.get(step - 1) {
            try_wires(bus, *pattern)?;
            return Ok(None);
        }
        let put = self.converter.put(bus, Command::ZERO, false);
        match put.trouble {
            Some(trouble) => Err(trouble),
            // The second time brings the control register as it is after 0 V was put out.
            None if step > PATTERNS.len() + 1 => Ok(Some(self.converter.clone())),
            None => Ok(None),
        }
    }
}

fn try_wires(bus: &mut impl Bus, sent: u16) -> Result<(), Trouble> {
    let mut send = |word| bus.exchange(word).ok_or(Trouble::Silent);
    send(words::write_input(sent))?;
    send(words::ask(Register::Input))?;
    let seen = send(words::ask(Register::Control))?;
    let seen = words::answer(Register::Input, seen).ok_or(Trouble::Silent)?;
    if seen == sent {
        Ok(())
    } else {
        Err(Trouble::Garbled { sent, seen })
    }
}
