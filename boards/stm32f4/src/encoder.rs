//! The encoder: TIM2 counts, TIM5 stamps every edge, both are latched at the tick by hardware.
//!
//! ```text
//! A ─┬─ PA15 ─► TIM2 ─► count ─────── TRC ─► CCR4 ┐
//! B ─┼┬ PB3  ─►  (x4)                             ├─ TIM8's update: the tick
//!    └┼ PA0  ─► TIM5 ─► A xor B ─► CCR1 ─► DMA ring
//!     └ PA1  ─►  84 MHz ───────────── TRC ─► CCR3 ┘
//! Z ─── PB10 ─► TIM2 CCR3      PA3 ─► TIM5 CCR4
//! ```

use core::sync::atomic::{Ordering, compiler_fence};

use embassy_stm32::pac;
use embassy_stm32::pac::dma::vals::{Dir, Pl, Size};
use embassy_stm32::pac::timer::vals::{CcmrInputCcs, FilterValue, Sms, Ti1s, Ts};

use leadscrew::hal::Latch;
use leadscrew_app::edge_ring::{Progress, Sample};
use leadscrew_app::input_filter::{InputFilter, Inputs, LineLimits};

use crate::clocks::TIMER_HZ;
use crate::gpio;
use crate::pins;

/// Times that the ring holds: four ticks of 1 ms at a million edges a second.
pub const RING: usize = 4096;
/// What they can follow: the fastest encoder of this class, the receivers of docs/board.md without capacitors at their inputs,
/// and the ring.
pub const INPUTS: Inputs = Inputs {
    limits: LineLimits {
        encoder_hz: 300e3,
        receiver_hz: 1e6,
    },
    timer_hz: TIMER_HZ as f64,
    ring_words: RING,
};
/// Of DMA 1.
const STREAM: usize = 2;
/// That of TIM5_CH1 on this stream.
const CHANNEL: u8 = 6;
/// Direct: what the pin of the same channel gives.
pub(crate) const DIRECT: CcmrInputCcs = CcmrInputCcs::TI4;

/// Index of a channel in the registers, which count from zero.
pub(crate) mod channel {
    pub const CH1: usize = 0;
    pub const CH2: usize = 1;
    pub const CH3: usize = 2;
    pub const CH4: usize = 3;
}
use channel::{CH1, CH2, CH3, CH4};

/// Sets both timers up and starts them; edges go to `ring` from now on and for ever.
pub fn start(ring: *mut [u32; RING], filter: InputFilter) {
    let filter = FilterValue::from_bits(filter.code());
    start_ring(ring);
    start_counter(filter);
    start_times(filter);
}

fn start_counter(filter: FilterValue) {
    let timer = pac::TIM2;
    timer.arr().write_value(u32::MAX);
    timer.ccmr_input(0).write(|w| {
        w.set_ccs(CH1, DIRECT);
        w.set_ccs(CH2, DIRECT);
        w.set_icf(CH1, filter);
        w.set_icf(CH2, filter);
    });
    timer.ccmr_input(1).write(|w| {
        w.set_ccs(CH3 - 2, DIRECT);
        w.set_icf(CH3 - 2, filter);
        w.set_ccs(CH4 - 2, CcmrInputCcs::TRC);
    });
    // The trigger first: it may not change once the mode is set. TIM8 is number 1.
    timer.smcr().write(|w| w.set_ts(Ts::ITR1));
    timer.smcr().modify(|w| w.set_sms(Sms::ENCODER_MODE_3));
    timer.ccer().write(|w| {
        w.set_cce(CH3, true);
        w.set_cce(CH4, true);
    });
    timer.cnt().write_value(first_count());
    timer.cr1().write(|w| w.set_cen(true));
}

/// The two low bits of the count tell the levels of A and B.
fn first_count() -> u32 {
    let a = gpio::is_high(pins::ENCODER_A_COUNT);
    let b = gpio::is_high(pins::ENCODER_B_COUNT);
    match (a, b) {
        (false, false) => 0,
        (true, false) => 1,
        (true, true) => 2,
        (false, true) => 3,
    }
}

fn start_times(filter: FilterValue) {
    let timer = pac::TIM5;
    timer.arr().write_value(u32::MAX);
    timer.cr2().write(|w| w.set_ti1s(Ti1s::XOR));
    timer.ccmr_input(0).write(|w| {
        w.set_ccs(CH1, DIRECT);
        w.set_icf(CH1, filter);
    });
    timer.ccmr_input(1).write(|w| {
        w.set_ccs(CH3 - 2, CcmrInputCcs::TRC);
        w.set_ccs(CH4 - 2, DIRECT);
        w.set_icf(CH4 - 2, filter);
    });
    // TIM8 is number 3.
    timer.smcr().write(|w| w.set_ts(Ts::ITR3));
    timer.ccer().write(|w| {
        w.set_cce(CH1, true);
        // Both edges.
        w.set_ccp(CH1, true);
        w.set_ccnp(CH1, true);
        w.set_cce(CH3, true);
        w.set_cce(CH4, true);
    });
    timer.dier().write(|w| w.set_ccde(CH1, true));
    timer.cr1().write(|w| w.set_cen(true));
}

fn start_ring(ring: *mut [u32; RING]) {
    let stream = pac::DMA1.st(STREAM);
    stream.cr().write(|w| w.set_en(false));
    while stream.cr().read().en() {}
    pac::DMA1.ifcr(STREAM / 4).write(|w| {
        w.set_tcif(STREAM % 4, true);
        w.set_htif(STREAM % 4, true);
        w.set_teif(STREAM % 4, true);
        w.set_dmeif(STREAM % 4, true);
        w.set_feif(STREAM % 4, true);
    });
    let source = pac::TIM5.ccr(CH1).as_ptr();
    stream.par().write_value(source as u32);
    stream.m0ar().write_value(ring as u32);
    stream.ndtr().write(|w| w.set_ndt(RING as u16));
    // Without its FIFO: a time is in memory as soon as it is fetched.
    stream.fcr().write(|_| {});
    stream.cr().write(|w| {
        w.set_chsel(CHANNEL);
        w.set_pl(Pl::VERY_HIGH);
        w.set_dir(Dir::PERIPHERAL_TO_MEMORY);
        w.set_psize(Size::BITS32);
        w.set_msize(Size::BITS32);
        w.set_minc(true);
        w.set_circ(true);
        w.set_en(true);
    });
}

/// What hardware latched at the tick, and how far the DMA has got. The order of the reads is the argument of
/// [`leadscrew_app::edge_ring`]: the sample, the flags, the position.
pub fn sample() -> (Sample, Progress) {
    let sample = Sample {
        count: pac::TIM2.ccr(CH4).read(),
        time: pac::TIM5.ccr(CH3).read(),
    };
    let times = pac::TIM5.sr().read();
    let flags = pac::DMA1.isr(STREAM / 4).read();
    let at = STREAM % 4;
    let (passed_middle, passed_end) = (flags.htif(at), flags.tcif(at));
    let is_broken = flags.teif(at) || flags.dmeif(at) || flags.feif(at);
    // What was read as set, and no other.
    pac::DMA1.ifcr(STREAM / 4).write(|w| {
        w.set_htif(at, passed_middle);
        w.set_tcif(at, passed_end);
        w.set_teif(at, flags.teif(at));
        w.set_dmeif(at, flags.dmeif(at));
        w.set_feif(at, flags.feif(at));
    });
    let is_lossy = is_broken || times.ccof(CH1);
    if times.ccof(CH1) {
        // A flag is cleared by a zero, and a one leaves it.
        pac::TIM5.sr().write(|w| {
            w.0 = u32::MAX;
            w.set_ccof(CH1, false);
        });
    }
    let progress = Progress {
        remaining: pac::DMA1.st(STREAM).ndtr().read().ndt(),
        passed_middle,
        passed_end,
        is_lossy,
    };
    // What the DMA wrote before its position is read after it.
    compiler_fence(Ordering::Acquire);
    (sample, progress)
}

/// The time now, clocks of [`crate::clocks::TIMER_HZ`].
#[inline(always)]
pub fn now() -> u32 {
    pac::TIM5.cnt().read()
}

/// The count now.
#[inline(always)]
pub fn count_now() -> u32 {
    pac::TIM2.cnt().read()
}

/// Count and time of an index that came since this was asked last, at `before`, if not after `sampled_at`: such a one is the next
/// tick's.
pub fn take_index(sampled_at: u32, before: Option<u32>) -> Option<Latch> {
    if !pac::TIM2.sr().read().ccif(CH3) {
        return None;
    }
    let time = pac::TIM5.ccr(CH4).read();
    // The timers' filters sample at their own clocks: of one index the count may be there some clocks before the time, which then
    // is that of the index before.
    let is_there = before != Some(time) && sampled_at.wrapping_sub(time).cast_signed() >= 0;
    if !is_there {
        return None;
    }
    // Reading the latch clears its flag; both belong to the same edge.
    let count = pac::TIM2.ccr(CH3).read();
    Some(Latch { count, time })
}
