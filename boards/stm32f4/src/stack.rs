//! How much of the stack was ever used: start-up code paints all of it, and what is painted still was not.

use core::sync::atomic::{AtomicU32, Ordering};

use board_common::paint;

/// What start-up code paints with (`paint-stack` of cortex-m-rt).
const PAINT: u32 = 0xcccc_cccc;
/// Words at the end that have to stay painted, which the tick looks at. A frame that leaves them as they were and goes beyond
/// leaves the memory: the processor locks up, and the watchdog ends it.
const GUARD: usize = 8;
/// Bytes that were free when it was told last.
static TOLD: AtomicU32 = AtomicU32::new(u32::MAX);

// SAFETY: the linker script (board.x, or link.x of cortex-m-rt) has both symbols; only their addresses are taken.
unsafe extern "C" {
    static _stack_end: u32;
    static _stack_start: u32;
}

fn end() -> *const u32 {
    &raw const _stack_end
}

/// Words of the whole stack.
fn words() -> usize {
    ((&raw const _stack_start) as usize - end() as usize) / size_of::<u32>()
}

fn is_painted(index: usize) -> bool {
    // SAFETY: within the stack, as callers ask for less than `words`, and aligned; volatile, as whoever runs above writes to it.
    unsafe { end().add(index).read_volatile() == PAINT }
}

/// Whether the stack has not reached its end.
#[inline]
pub fn is_whole() -> bool {
    (0..GUARD).all(is_painted)
}

/// Bytes that were never used. Takes a clock or ten for each of its words: for thread mode.
pub fn free_bytes() -> u32 {
    (paint::untouched(words(), is_painted) * size_of::<u32>()) as u32
}

/// Tells how much was never used, when that has become less.
pub fn tell() {
    let free = free_bytes();
    if free < TOLD.swap(free, Ordering::Relaxed) {
        let all = (words() * size_of::<u32>()) as u32;
        defmt::info!("stack: {=u32} of {=u32} bytes never used", free, all);
    }
}
