//! ADC1 in continuous conversion with requests to the DMA: as much of it as the analog command needs. RM0090, chapter 13.

use super::pins::SharedSurroundings;
use super::registers::{Model, NEVER};
use crate::emulator::lock;

const DONE: u32 = 1 << 1;
const STARTED: u32 = 1 << 4;
const ON: u32 = 1 << 0;
const CONTINUOUS: u32 = 1 << 1;
const DMA: u32 = 1 << 8;
const START: u32 = 1 << 30;
/// Clocks of a conversion: 480 and 12 of the converter's, an eighth of which are ours at the slowest.
const CONVERSION: u64 = 492 * 8;

/// The registers.
pub struct Adc {
    around: SharedSurroundings,
    registers: [u32; 19],
    /// Of all three converters together.
    common: u32,
    /// When the conversion ends.
    ends: u64,
    is_asking: bool,
}

impl std::fmt::Debug for Adc {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Adc").finish_non_exhaustive()
    }
}

/// Places of status, second control and data register.
const STATUS: usize = 0;
const CONTROL: usize = 2;
const DATA: usize = 19;
/// Place of the control register that all three have in common.
const COMMON: usize = 0x304 / 4;

impl Adc {
    pub const fn new(around: SharedSurroundings) -> Self {
        Self {
            around,
            registers: [0; 19],
            common: 0,
            ends: NEVER,
            is_asking: false,
        }
    }
}

impl Model for Adc {
    fn read(&mut self, offset: u64, _now: u64, looks_only: bool) -> u32 {
        let place = offset as usize / 4;
        if place == COMMON {
            return self.common;
        }
        if place != DATA {
            return self.registers.get(place).copied().unwrap_or_default();
        }
        if !looks_only {
            self.registers[STATUS] &= !DONE;
            self.is_asking = false;
        }
        lock(&self.around).analog().into()
    }

    fn write(&mut self, offset: u64, value: u32, now: u64) {
        let place = offset as usize / 4;
        match place {
            COMMON => self.common = value,
            STATUS => self.registers[STATUS] &= value,
            CONTROL => {
                self.registers[CONTROL] = value & !START;
                if value & (START | ON) == START | ON {
                    self.registers[STATUS] |= STARTED;
                    self.ends = now + CONVERSION;
                }
                if value & ON == 0 {
                    self.ends = NEVER;
                }
            }
            _ => {
                if let Some(register) = self.registers.get_mut(place) {
                    *register = value;
                }
            }
        }
    }

    fn advance(&mut self, now: u64) {
        while self.ends <= now {
            self.registers[STATUS] |= DONE;
            self.is_asking = self.registers[CONTROL] & DMA != 0;
            if self.registers[CONTROL] & CONTINUOUS != 0 {
                self.ends += CONVERSION;
            } else {
                self.ends = NEVER;
            }
        }
    }

    fn next_event(&self) -> u64 {
        self.ends
    }

    fn lines(&self) -> [bool; 2] {
        [false, self.is_asking]
    }

    fn reset(&mut self, _now: u64) {
        *self = Self::new(self.around.clone());
    }
}
