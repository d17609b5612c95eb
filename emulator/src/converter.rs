//! The AD5761R at the part's SPI: frames of 24 bits between falling and rising chip select.
//!
//! Analog Devices, AD5761/AD5721R/AD5761R data sheet, "Input shift register", "Control register", "Readback".

/// Command that writes the input register, which goes out when /LDAC is low.
const WRITE_INPUT: u8 = 0b0001;
/// Command that puts the input register out.
const UPDATE: u8 = 0b0010;
/// Command that writes and puts out.
const WRITE_AND_UPDATE: u8 = 0b0011;
/// Command that writes the control register.
const WRITE_CONTROL: u8 = 0b0100;
/// Command that resets the data registers.
const RESET_DATA: u8 = 0b0111;
/// Commands that let the next frame give a register.
const READ_INPUT: u8 = 0b1010;
const READ_OUTPUT: u8 = 0b1011;
const READ_CONTROL: u8 = 0b1100;
/// Command that resets all.
const RESET: u8 = 0b1111;

/// The converter.
#[derive(Clone, Debug, Default)]
pub struct Ad5761r {
    /// What the control register was set to; until then the output is clamped to ground.
    control: Option<u16>,
    input: u16,
    output: u16,
    /// Chip select is low, with the bits so far and their number.
    frame: Option<(u32, u32)>,
    /// What the next frame gives.
    answer: u32,
    is_held: bool,
    /// Held in reset by its pin.
    in_reset: bool,
    frames: u64,
    broken_frames: u64,
    values: u64,
}

impl Ad5761r {
    /// Chip select goes to a level; its rise ends the frame.
    pub fn select(&mut self, level: bool) {
        if !level {
            self.frame = Some((0, 0));
        } else if let Some((bits, count)) = self.frame.take().filter(|&(_, count)| count > 0) {
            self.frames += 1;
            if count == 24 && !self.in_reset {
                self.obey(bits);
            } else {
                self.broken_frames += 1;
            }
        }
    }

    /// A byte goes in, and one comes out.
    pub fn transfer(&mut self, byte: u8) -> u8 {
        let Some((bits, count)) = &mut self.frame else {
            // Not selected: the output floats.
            return 0xff;
        };
        let out = self.answer.wrapping_shr(16_u32.saturating_sub(*count));
        *bits = *bits << 8 | u32::from(byte);
        *count += 8;
        out as u8
    }

    /// /LDAC goes to a level; low lets the input register through.
    pub fn hold(&mut self, level: bool) {
        self.is_held = level;
        if !level {
            self.output = self.input;
        }
    }

    /// /RESET goes to a level.
    pub fn reset(&mut self, level: bool) {
        self.in_reset = !level;
        if self.in_reset {
            self.start_anew();
        }
    }

    /// What it puts out, V.
    #[must_use]
    pub fn volts(&self) -> f64 {
        let Some(control) = self.control.filter(|_| !self.in_reset) else {
            return 0.0;
        };
        let (low, span) = match control & 7 {
            0 => (-10.0, 20.0),
            1 => (0.0, 10.0),
            2 => (-5.0, 10.0),
            3 => (0.0, 5.0),
            4 => (-2.5, 10.0),
            5 => (-3.0, 6.0),
            6 => (0.0, 16.0),
            _ => (0.0, 20.0),
        };
        let is_signed = control & 1 << 7 != 0;
        let code = if is_signed {
            self.output ^ 0x8000
        } else {
            self.output
        };
        low + span * f64::from(code) / 65_536.0
    }

    /// Frames so far, and those that were not 24 bits long or came while it was in reset.
    #[must_use]
    pub const fn frames(&self) -> (u64, u64) {
        (self.frames, self.broken_frames)
    }

    /// Values that it was given to put out at once.
    #[must_use]
    pub const fn values(&self) -> u64 {
        self.values
    }

    fn obey(&mut self, bits: u32) {
        let command = (bits >> 16 & 0xf) as u8;
        let data = bits as u16;
        self.answer = bits;
        match command {
            WRITE_INPUT => {
                self.input = data;
                if !self.is_held {
                    self.output = data;
                }
            }
            UPDATE => self.output = self.input,
            WRITE_AND_UPDATE => {
                (self.input, self.output) = (data, data);
                self.values += 1;
            }
            WRITE_CONTROL => self.set_control(data),
            RESET_DATA => self.clear(),
            READ_INPUT => self.answer_with(command, self.input),
            READ_OUTPUT => self.answer_with(command, self.output),
            READ_CONTROL => self.answer_with(command, self.control.unwrap_or_default()),
            RESET => self.start_anew(),
            _ => {}
        }
    }

    fn answer_with(&mut self, command: u8, value: u16) {
        self.answer = u32::from(command) << 16 | u32::from(value);
    }

    /// The first control word brings the output to its power-up value.
    fn set_control(&mut self, data: u16) {
        let is_first = self.control.is_none();
        self.control = Some(data & 0x07ff);
        if is_first {
            self.clear();
        }
    }

    /// To the value that the control register chooses for clearing: zero scale, mid scale or full scale.
    fn clear(&mut self) {
        let control = self.control.unwrap_or_default();
        let straight = match control >> 3 & 3 {
            0 => 0,
            1 => 0x8000,
            _ => 0xffff,
        };
        let value = if control & 1 << 7 != 0 {
            straight ^ 0x8000
        } else {
            straight
        };
        (self.input, self.output) = (value, value);
    }

    fn start_anew(&mut self) {
        self.control = None;
        (self.input, self.output) = (0, 0);
        self.answer = 0;
    }
}
