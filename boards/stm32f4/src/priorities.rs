//! Priorities of the interrupts: 0 latches, 1 the tick, all others below.

use cortex_m::peripheral::NVIC;
use embassy_stm32::pac::Interrupt;

/// The four bits that the chip has are the upper ones.
const fn level(priority: u8) -> u8 {
    priority << 4
}

const LATCH: u8 = level(0);
const TICK: u8 = level(1);
const TIME: u8 = level(3);
const UART: u8 = level(4);
const REPORT: u8 = level(15);

const LINES: [(Interrupt, u8); 7] = [
    (Interrupt::TIM1_CC, LATCH),
    (Interrupt::EXTI9_5, LATCH),
    (Interrupt::TIM8_UP_TIM13, TICK),
    (Interrupt::TIM8_BRK_TIM12, TIME),
    (Interrupt::USART1, UART),
    (Interrupt::USART6, UART),
    (Interrupt::SDIO, REPORT),
];

/// Sets all of them and unmasks the lines; what the handlers work with is in place.
pub fn unmask(nvic: &mut NVIC) {
    for (line, priority) in LINES {
        // SAFETY: critical sections mask by PRIMASK, so they hold at any priority; the handlers share only what `IsrCell`,
        // atomics and the two ends of queues protect.
        unsafe {
            nvic.set_priority(line, priority);
            NVIC::unmask(line);
        }
    }
}
