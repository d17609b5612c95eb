//! What the board puts out: the converter's voltage, and the relays of enable and brake.

use leadscrew::axis::Outputs;
use leadscrew::units::Command;

use super::wired;
use crate::converter::Ad5761r;
use crate::emulator::Pin;

/// Volts of full command.
const FULL_VOLTS: f64 = 10.0;

/// What was put out since it was asked last.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PutOut {
    /// The drive was enabled at some time.
    pub enabled: bool,
    /// The brake was released at some time.
    pub brake_released: bool,
    /// Largest output of the converter to either side, V.
    pub volts: f64,
}

/// The converter and the relays, as the board's pins lead them.
#[derive(Debug, Default)]
pub struct BoardOutputs {
    pub converter: Ad5761r,
    /// Levels of the relays of enable and brake.
    pub relays: (bool, bool),
    /// The clocks at which the relays went to the levels that they have.
    pub relays_changed_at: [u64; 2],
    /// When the converter was given its last value.
    pub converted_at: u64,
    seen: PutOut,
}

impl BoardOutputs {
    /// What the drive is told, as a share of full command.
    pub fn command(&self) -> f64 {
        self.converter.volts() / FULL_VOLTS
    }

    /// What the drive is told, by the wires that it really has.
    pub fn to_drive(&self) -> Outputs {
        let (enabled, brake_released) = self.relays;
        Outputs {
            command: Command::saturating_from_num(self.command()),
            enabled,
            brake_released,
            ..Outputs::default()
        }
    }

    /// True while nothing can move.
    pub fn is_safe(&self) -> bool {
        // Half of the converter's last bit.
        self.relays == (false, false) && self.converter.volts().abs() < 2e-4
    }

    /// What was put out since this was asked last.
    pub fn take_seen(&mut self) -> PutOut {
        std::mem::take(&mut self.seen)
    }

    /// A pin of the board goes to a level.
    pub fn change(&mut self, clock: u64, pin: Pin, level: bool) {
        let (enable, brake_released) = self.relays;
        match pin {
            wired::CONVERTER_SYNC => {
                let before = self.converter.values();
                self.converter.select(level);
                if self.converter.values() != before {
                    self.converted_at = clock;
                }
            }
            wired::CONVERTER_LOAD => self.converter.hold(level),
            wired::CONVERTER_RESET => self.converter.reset(level),
            wired::ENABLE if level != enable => {
                self.relays.0 = level;
                self.relays_changed_at[0] = clock;
            }
            wired::BRAKE if level != brake_released => {
                self.relays.1 = level;
                self.relays_changed_at[1] = clock;
            }
            _ => {}
        }
        let volts = self.converter.volts().abs();
        self.seen.enabled |= self.relays.0;
        self.seen.brake_released |= self.relays.1;
        self.seen.volts = self.seen.volts.max(volts);
    }
}
