//! An AD5761R by its data sheet: shift register, registers, answers with the next word.

use leadscrew_app::converter::Bus;

/// The chip and what may be wrong with it.
#[derive(Default)]
pub struct Chip {
    pub input: u16,
    pub output: u16,
    pub control: u16,
    /// Every code that was put out.
    pub seen_out: Vec<u16>,
    pub words: u32,
    /// The bus does not end.
    pub is_dead: bool,
    /// What comes back whatever is sent.
    pub stuck: Option<u32>,
    pub is_shorted: bool,
    pub is_control_locked: bool,
    /// /LDAC is low: what comes into the input register is put out.
    pub is_let_through: bool,
    pub is_held_in_reset: bool,
    /// Bits of a code that do not arrive.
    pub lost_bits: u16,
    is_brown: bool,
    /// The output is clamped to ground until the control register was written.
    is_up: bool,
    answer: u32,
}

impl Chip {
    /// What the output gives, V.
    pub fn volts(&self) -> f64 {
        if self.is_up {
            20.0 * f64::from(self.output) / 65536.0 - 10.0
        } else {
            0.0
        }
    }

    /// To the state after power-up; what is wrong with it stays.
    fn reset(&mut self) {
        (self.input, self.output, self.control) = (0, 0, 0);
        (self.is_brown, self.is_up, self.answer) = (false, false, 0);
    }

    pub fn brown_out(&mut self) {
        self.is_brown = true;
        self.is_up = false;
        self.control = 0;
    }

    pub fn exchange_word(&mut self, word: u32) -> u32 {
        assert_eq!(word >> 20, 0, "bit 20 is 0, those above do not matter");
        self.words += 1;
        let data = word as u16 & !self.lost_bits;
        let command = word >> 16 & 0xf;
        // Bits 23 to 21 of an answer are not defined.
        let back = self.answer | 0xa0_0000;
        self.answer = 0x1f_5a5a;
        match command {
            0x1 => {
                self.input = data;
                if self.is_let_through {
                    self.output = data;
                    self.seen_out.push(data);
                }
            }
            0x3 => {
                self.input = data;
                self.output = data;
                self.seen_out.push(data);
            }
            0x4 if !self.is_control_locked => {
                self.control = data;
                self.is_brown = false;
                self.is_up = true;
            }
            0xa => self.answer = 0x0a_0000 | u32::from(self.input),
            0xb => self.answer = 0x0b_0000 | u32::from(self.output),
            0xc => {
                let flags = u32::from(self.is_shorted) << 12 | u32::from(self.is_brown) << 11;
                self.answer = 0x0c_0000 | flags | u32::from(self.control);
            }
            0xf => self.reset(),
            _ => {}
        }
        back
    }
}

impl Bus for Chip {
    fn exchange(&mut self, word: u32) -> Option<u32> {
        if self.is_dead {
            return None;
        }
        if self.is_held_in_reset {
            return Some(0x1f_ffff);
        }
        let back = self.exchange_word(word);
        Some(self.stuck.unwrap_or(back))
    }

    fn hold_reset(&mut self, is_held: bool) {
        self.is_held_in_reset = is_held;
        self.reset();
    }
}
