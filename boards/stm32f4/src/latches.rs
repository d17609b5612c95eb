//! Probe and home switch: TIM1 stamps their edges, its interrupt makes the stamps wide and notes the count.
//!
//! TIM1 runs at the clock of TIM5. The interrupt has the highest priority, so the stamp is far younger than a lap of its
//! 16 bits; the count is the fallback where the ring of edges does not tell it (`leadscrew_app::edge_ring::count_at`).

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use embassy_stm32::interrupt;
use embassy_stm32::pac;
use embassy_stm32::pac::timer::vals::FilterValue;
use leadscrew::hal::Latch;
use leadscrew_app::edge_ring::Clock16;
use leadscrew_app::input_filter::InputFilter;

use crate::clocks::{FAST_TIMER_HZ, TIMER_HZ};
use crate::encoder::channel::{CH1, CH4};
use crate::encoder::{self, DIRECT};

/// 8 samples, each of 8 clocks of TIM1: interference below 0.4 µs is no edge. What bounces longer is not waited out, which would
/// make every stamp late by as much: the first edge is the one that counts, and debouncing is for whoever acts on it.
const FILTER: FilterValue = FilterValue::FDTS_DIV8_N8;
/// The same in clocks of TIM5.
const FILTER_CLOCKS: u16 = (8 * 8 / (FAST_TIMER_HZ / TIMER_HZ)) as u16;

/// An edge on its way from the latch interrupt to the tick; the first one since the tick looked.
pub struct Stamp {
    is_full: AtomicBool,
    count: AtomicU32,
    time: AtomicU32,
}

/// The probe was triggered.
pub static PROBE: Stamp = Stamp::new();
/// The home switch was actuated.
pub static HOME: Stamp = Stamp::new();
/// What makes a stamp one of the encoder's edges: these come through a longer filter, later by as much.
static SHIFT: AtomicU32 = AtomicU32::new(0);
/// Phase of TIM1 against TIM5.
static OFFSET: AtomicU32 = AtomicU32::new(0);

impl Stamp {
    const fn new() -> Self {
        Self {
            is_full: AtomicBool::new(false),
            count: AtomicU32::new(0),
            time: AtomicU32::new(0),
        }
    }

    /// The latch interrupt alone calls this.
    fn note(&self, latch: Latch) {
        if !self.is_full.load(Ordering::Acquire) {
            self.count.store(latch.count, Ordering::Relaxed);
            self.time.store(latch.time, Ordering::Relaxed);
            self.is_full.store(true, Ordering::Release);
        }
    }

    /// The tick alone calls this: the edge, if it is not later than `sampled_at`; a later one is the next tick's. The count is the one
    /// that the interrupt read, some clocks after the edge.
    pub fn take(&self, sampled_at: u32) -> Option<Latch> {
        if !self.is_full.load(Ordering::Acquire) {
            return None;
        }
        let latch = Latch {
            count: self.count.load(Ordering::Relaxed),
            time: self.time.load(Ordering::Relaxed),
        };
        if sampled_at.wrapping_sub(latch.time).cast_signed() < 0 {
            return None;
        }
        self.is_full.store(false, Ordering::Release);
        Some(latch)
    }
}

/// Sets TIM1 up and starts it; TIM5 runs, with `encoder` at its inputs. Its interrupt has to be masked.
pub fn start(encoder: InputFilter) {
    let shift = encoder.later_than(FILTER_CLOCKS);
    SHIFT.store(shift.cast_unsigned(), Ordering::Relaxed);
    let timer = pac::TIM1;
    timer
        .psc()
        .write_value((FAST_TIMER_HZ / TIMER_HZ - 1) as u16);
    timer.arr().write(|w| w.set_arr(u16::MAX));
    timer.ccmr_input(0).write(|w| {
        w.set_ccs(CH1, DIRECT);
        w.set_icf(CH1, FILTER);
    });
    timer.ccmr_input(1).write(|w| {
        w.set_ccs(CH4 - 2, DIRECT);
        w.set_icf(CH4 - 2, FILTER);
    });
    timer.ccer().write(|w| {
        w.set_cce(CH1, true);
        w.set_cce(CH4, true);
    });
    timer.dier().write(|w| {
        w.set_ccie(CH1, true);
        w.set_ccie(CH4, true);
    });
    timer.egr().write(|w| w.set_ug(true));
    timer.sr().write(|_| {});
    timer.cr1().write(|w| w.set_cen(true));
    measure_offset();
}

/// The narrow timer is read between two readings of the wide one, whose mean is the same instant.
fn measure_offset() {
    let (before, narrow, after) = critical_section::with(|_| {
        let before = encoder::now();
        (before, pac::TIM1.cnt().read().cnt(), encoder::now())
    });
    let wide = before.wrapping_add(after.wrapping_sub(before) / 2);
    let offset = u32::from(narrow.wrapping_sub(wide as u16));
    OFFSET.store(offset, Ordering::Relaxed);
}

#[interrupt]
fn TIM1_CC() {
    let timer = pac::TIM1;
    let status = timer.sr().read();
    let count = encoder::count_now();
    let now = encoder::now();
    let clock = Clock16::new(OFFSET.load(Ordering::Relaxed) as u16, 0);
    let shift = SHIFT.load(Ordering::Relaxed);
    for (channel, stamp) in [(CH1, &PROBE), (CH4, &HOME)] {
        if status.ccif(channel) {
            // Reading the latch clears its flag.
            let narrow = timer.ccr(channel).read().ccr();
            let time = clock.extend16(narrow, now).wrapping_add(shift);
            stamp.note(Latch { count, time });
        }
    }
}
