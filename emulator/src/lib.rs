//! The release image of the STM32F4 axis board on an emulated part, with the simulated machine at its pins.
//!
//! ```text
//! ELF ─► Part (an Emulator) ─► pins, SPI, ADC ─► Surroundings: machine at the pins, converter, switches
//!          │  USART                                    ▲
//!          └───────► EmulatedAxis (a Line) ─► client   └── tests cause troubles, look at the drive's command
//! ```
//!
//! The image is the one that is flashed, byte for byte. [`Emulator`] and [`Surroundings`] are the seam: whatever else can
//! run an STM32F4 takes the place of [`Part`], which is the only thing here that knows of `rsemu`.
//!
//! All times are counted in [`CLOCK_HZ`], the clock of the timers that stamp edges.

mod axis_machine;
mod converter;
mod elf;
mod emulated_axis;
mod emulator;
mod part;
mod quadrature_lines;

pub use axis_machine::{AxisMachine, MachineHandle, PutOut};
pub use converter::Ad5761r;
pub use elf::{Elf, ElfError};
pub use emulated_axis::{EmulatedAxis, NoFirmware, firmware};
pub use emulator::{Emulator, EmulatorError, Pin, Serial, Surroundings};
pub use part::Part;

/// Clock of all times here, Hz: that of TIM5 on the part.
pub const CLOCK_HZ: u64 = 84_000_000;
/// Clocks of a millisecond.
pub const MILLISECOND: u64 = CLOCK_HZ / 1000;
