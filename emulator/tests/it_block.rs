//! An interrupt within an IT block leaves the block as it was.

mod support;

use leadscrew_emulator::{AxisMachine, Emulator as _, Part};
use leadscrew_hal_mock::scenario::Base;
use support::*;

/// Where the program counts what it never should do, and its interrupts.
const WRONG: u32 = 0x2000_0100;
const INTERRUPTS: u32 = 0x2000_0104;
/// Places of the vector of TIM2, of the program, and of its constants in the flash.
const VECTOR: usize = 0xb0;
const MAIN: usize = 0x200;
const CONSTANTS: usize = 0x240;

/// Counts in a loop under a condition that never holds, and lets TIM2 interrupt it.
const PROGRAM: &[u16] = &[
    0x4b0f, // ldr r3, =0xe000e100
    0x4a10, // ldr r2, =1 << 28
    0x601a, // str r2, [r3]
    0x4c10, // ldr r4, =WRONG
    0x2000, // movs r0, #0
    0x2100, // movs r1, #0
    0x6061, // str r1, [r4, #4]
    0x2801, // cmp r0, #1
    0xbf01, // itttt eq
    0x3101, // addeq r1, #1
    0x3101, // addeq r1, #1
    0x3101, // addeq r1, #1
    0x3101, // addeq r1, #1
    0x6021, // str r1, [r4]
    0xe7f7, // b to the comparison
    0xbf00, // nop
    0x4b0a, // the handler, at 0x220: ldr r3, =TIM2
    0x2200, // movs r2, #0
    0x611a, // str r2, [r3, #0x10]
    0x6862, // ldr r2, [r4, #4]
    0x3201, // adds r2, #1
    0x6062, // str r2, [r4, #4]
    0x4770, // bx lr
];

#[test]
fn an_interrupt_leaves_an_it_block_as_it_was() {
    let mut flash = Part::blank_flash();
    let mut put = |place: usize, word: u32| {
        flash[place..place + 4].copy_from_slice(&word.to_le_bytes());
    };
    put(0, 0x2002_0000);
    put(4, 0x0800_0201);
    put(VECTOR, 0x0800_0221);
    for (place, word) in [0xe000_e100, 1 << 28, WRONG, TIM2].into_iter().enumerate() {
        put(CONSTANTS + 4 * place, word);
    }
    for (place, half) in PROGRAM.iter().enumerate() {
        let at = MAIN + 2 * place;
        flash[at..at + 2].copy_from_slice(&half.to_le_bytes());
    }
    let machine = AxisMachine::workshop(Base::Bare, 1).expect("the workshop's machine");
    let mut part = Part::new(flash, machine).expect("the part");
    part.poke(RCC + 0x40, 1);
    run_us(&mut part, 100);
    for (register, value) in [(ARR, 997), (EGR, 1), (SR, 0), (DIER, 1), (CR1, 1)] {
        part.poke(TIM2 + register, value);
    }
    run_us(&mut part, 20_000);
    let interrupts = word(&part, INTERRUPTS);
    assert!(interrupts > 1_500, "{interrupts}");
    assert_eq!(word(&part, WRONG), 0, "of {interrupts} interrupts");
}
