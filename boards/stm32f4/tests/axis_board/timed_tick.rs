//! The firmware's own handler of the tick, timed from outside: the vector table is copied to the RAM, and there the tick's entry
//! leads through here.

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::{DWT, SCB};
use embassy_stm32::interrupt;
use embassy_stm32::pac;

use crate::spread::Spread;

/// Vectors of the part, rounded up: the table is aligned to its size.
const VECTORS: usize = 128;
/// Those of the processor come first.
const EXCEPTIONS: usize = 16;

/// From the timer's update to the handler's first instruction, cycles.
pub static START: Spread = Spread::new();
/// From there to its last one, cycles.
pub static TOTAL: Spread = Spread::new();
/// Cycles of a count of TIM8.
static DIVIDER: AtomicU32 = AtomicU32::new(1);

#[repr(C, align(512))]
struct Table(UnsafeCell<[usize; VECTORS]>);

// SAFETY: `install` alone writes it, before the processor reads it.
unsafe impl Sync for Table {}

static TABLE: Table = Table(UnsafeCell::new([0; VECTORS]));

unsafe extern "C" {
    /// The firmware's.
    fn TIM8_UP_TIM13();
}

extern "C" fn timed() {
    let begun = DWT::cycle_count();
    let since_update = u32::from(pac::TIM8.cnt().read().cnt());
    START.note(since_update * DIVIDER.load(Ordering::Relaxed));
    // SAFETY: in place of the processor, which would have called it just so.
    unsafe { TIM8_UP_TIM13() };
    TOTAL.note(DWT::cycle_count().wrapping_sub(begun));
}

/// Leads the tick through here; its interrupt is masked. `divider`: cycles of a count of TIM8. Once.
pub fn install(scb: &mut SCB, divider: u16) {
    DIVIDER.store(divider.into(), Ordering::Relaxed);
    let flashed = scb.vtor.read() as *const usize;
    let table = TABLE.0.get().cast::<usize>();
    // SAFETY: the part's table is in a sector of 16 KB, all of which may be read; nobody else works with ours yet.
    // The tick's entry is within it, and a function of the same kind as the other entries.
    unsafe {
        table.copy_from(flashed, VECTORS);
        let tick = EXCEPTIONS + interrupt::TIM8_UP_TIM13 as usize;
        table.add(tick).write(timed as *const () as usize);
        cortex_m::asm::dsb();
        scb.vtor.write(table as u32);
    }
    cortex_m::asm::dsb();
}
