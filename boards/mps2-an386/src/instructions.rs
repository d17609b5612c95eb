//! Counts instructions by SysTick, under QEMU with `-icount shift=N`.
//!
//! There one instruction takes 2^N ns of virtual time whatever it is, and SysTick counts 40 ns. At
//! shift 10 (25.6 counts an instruction) the figure is exact; see [`Counter::calibrate`]. It is a
//! number of instructions, never of cycles.

use core::arch::asm;
use core::hint::black_box;

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

use crate::timer::Timer;

const NS_PER_COUNT: u32 = 1_000_000_000 / crate::CLOCK_HZ;
const FULL: u32 = 0x00ff_ffff;

/// What keeps a count from being trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum CountError {
    /// `shift` is outside 7 to 10: SysTick is too coarse below, and QEMU goes no further.
    Shift(u32),
    /// A sled of `nops` counted as `counted`: QEMU does not run with this `-icount shift`.
    Inexact {
        /// Instructions in the sled.
        nops: u32,
        /// Instructions counted.
        counted: u32,
    },
}

/// A calibrated counter.
pub struct Counter {
    timer: SYST,
    shift: u32,
    base: u32,
}

impl Counter {
    /// Measures the cost of counting itself, and checks the counter against sleds of `nop`.
    pub fn calibrate(timer: SYST, shift: u32) -> Result<Self, CountError> {
        if !(7..=10).contains(&shift) {
            return Err(CountError::Shift(shift));
        }
        let mut counter = Self {
            timer,
            shift,
            base: 0,
        };
        counter.timer.set_clock_source(SystClkSource::Core);
        counter.timer.set_reload(FULL);
        counter.timer.enable_counter();
        counter.base = counter.count(sled::<0>);
        counter.check(1, sled::<1>)?;
        counter.check(10, sled::<10>)?;
        counter.check(100, sled::<100>)?;
        counter.check(1_000, sled::<1_000>)?;
        Ok(counter)
    }

    /// Instructions of one call of `work`, the call itself and the return left out.
    ///
    /// # Panics
    /// If `work` is longer than SysTick counts (655 000 instructions at shift 10).
    pub fn count<R>(&mut self, mut work: impl FnMut() -> R) -> u32 {
        // Called through a pointer the compiler cannot see through, so that nothing of the work moves
        // across the two readings.
        let call: fn(&mut dyn FnMut()) = black_box(|work| work());
        let mut work = || {
            black_box(work());
        };
        self.timer.clear_current();
        let (start, end) = cortex_m::interrupt::free(|_| {
            let start = SYST::get_current();
            call(&mut work);
            (start, SYST::get_current())
        });
        assert!(
            !self.timer.has_wrapped(),
            "the work is longer than SysTick counts: use a smaller shift"
        );
        let counts = start.wrapping_sub(end) & FULL;
        self.instructions(counts).wrapping_sub(self.base)
    }

    /// The same for work of any length up to 160 million instructions, on a timer that nobody else uses and whose
    /// interrupt is masked; to within a few instructions.
    pub fn count_long<R>(&mut self, timer: &Timer, mut work: impl FnMut() -> R) -> u32 {
        let call: fn(&mut dyn FnMut()) = black_box(|work| work());
        let time = |work: &mut dyn FnMut()| {
            timer.start(u32::MAX, u32::MAX);
            let start = timer.since_reload();
            call(work);
            let counts = timer.since_reload().wrapping_sub(start);
            let ns = u64::from(counts) * u64::from(NS_PER_COUNT);
            // Below 2³² from shift 6 on.
            ((ns + (1 << (self.shift - 1))) >> self.shift) as u32
        };
        let base = time(&mut || {});
        let counted = time(&mut || {
            black_box(work());
        });
        timer.stop();
        counted.saturating_sub(base)
    }

    fn check(&mut self, nops: u32, sled: fn()) -> Result<(), CountError> {
        let counted = self.count(sled);
        if counted == nops {
            Ok(())
        } else {
            Err(CountError::Inexact { nops, counted })
        }
    }

    /// To the nearest; 2²⁴ · 40 stays below 2³².
    fn instructions(&self, counts: u32) -> u32 {
        (counts * NS_PER_COUNT + (1 << (self.shift - 1))) >> self.shift
    }
}

/// `NOPS` times `nop` and a return.
#[inline(never)]
fn sled<const NOPS: u32>() {
    // SAFETY: `nop` reads and writes nothing.
    unsafe {
        asm!(".rept {nops}", "nop", ".endr", nops = const NOPS, options(nomem, nostack, preserves_flags));
    }
}
