//! A part whose core does nothing, with registers set from outside as a program would set them.
#![allow(dead_code, reason = "every test file uses a part of it")]

use leadscrew_emulator::{AxisMachine, Emulator as _, MachineHandle, Part};
use leadscrew_hal_mock::scenario::Base;

pub const RCC: u32 = 0x4002_3800;
pub const TIM1: u32 = 0x4001_0000;
pub const TIM2: u32 = 0x4000_0000;
pub const TIM3: u32 = 0x4000_0400;
pub const TIM4: u32 = 0x4000_0800;
pub const TIM5: u32 = 0x4000_0c00;
pub const TIM8: u32 = 0x4001_0400;
pub const DMA1: u32 = 0x4002_6000;
pub const CR1: u32 = 0x00;
pub const CR2: u32 = 0x04;
pub const SMCR: u32 = 0x08;
pub const DIER: u32 = 0x0c;
pub const SR: u32 = 0x10;
pub const EGR: u32 = 0x14;
pub const CCMR1: u32 = 0x18;
pub const CCMR2: u32 = 0x1c;
pub const CCER: u32 = 0x20;
pub const CNT: u32 = 0x24;
pub const PSC: u32 = 0x28;
pub const ARR: u32 = 0x2c;
pub const CCR1: u32 = 0x34;
pub const CCR3: u32 = 0x3c;
pub const CCR4: u32 = 0x40;
pub const RING: u32 = 0x2000_1000;

/// A part that only loops, with the clocks of its peripherals on.
pub fn idle_part() -> (Part, MachineHandle) {
    let machine = AxisMachine::workshop(Base::Bare, 1).expect("the workshop's machine");
    let mut flash = Part::blank_flash();
    let program = [0x2002_0000_u32, 0x0800_0009, 0xe7fe_e7fe];
    for (place, word) in flash.chunks_exact_mut(4).zip(program) {
        place.copy_from_slice(&word.to_le_bytes());
    }
    let mut part = Part::new(flash, MachineHandle::clone(&machine)).expect("the part");
    part.poke(RCC + 0x30, 0x0060_00ff);
    part.poke(RCC + 0x40, 0x1000_007f);
    part.poke(RCC + 0x44, 0x0000_5133);
    run_us(&mut part, 100);
    (part, machine)
}

/// Lets time pass.
pub fn run_us(part: &mut Part, microseconds: u64) {
    let until = part.now() + microseconds * 84;
    part.run_until(until).expect("it runs");
}

/// A word that has to be there.
pub fn word(part: &Part, address: u32) -> u32 {
    part.peek(address).expect("a register")
}
