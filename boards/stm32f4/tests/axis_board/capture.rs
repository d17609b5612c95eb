//! The capture of an encoder whose edges are known.

use board_stm32f4::clocks::{FAST_TIMER_HZ, TIMER_HZ};
use board_stm32f4::encoder::{self, RING};
use board_stm32f4::ring::EDGES;
use board_stm32f4::tick;
use embassy_stm32::pac;
use leadscrew_app::edge_ring::{EdgeRing, Taken};
use leadscrew_app::input_filter::InputFilter;
use leadscrew_app::tick_period::TickPeriod;

use crate::generator::Generator;
use crate::spacing::{Reversal, Spacing};

const TICK_HZ: u32 = 1_000;
/// Clocks of TIM5 from tick to tick.
const PERIOD: u32 = TIMER_HZ / TICK_HZ;
/// Ticks of a run, and those that are left out until the timers have settled.
const TICKS: u32 = 500;
const SETTLING: u32 = 3;
/// A clock of the timer, to either side.
const EXACT: u32 = 1;

/// The encoder's inputs, sampled by TIM8, whose interrupt stays masked.
struct Inputs {
    ring: EdgeRing<RING>,
}

impl Inputs {
    /// For a generator that runs.
    fn start() -> Self {
        let filter = InputFilter::shortest();
        encoder::start(EDGES.address(), filter);
        let period = TickPeriod::nearest(FAST_TIMER_HZ, TICK_HZ.into());
        tick::start(defmt::unwrap!(period, "no such rate"));
        let mut inputs = Self {
            ring: EdgeRing::new(filter.skew_clocks()),
        };
        for _ in 0..SETTLING {
            inputs.tick(0);
        }
        inputs
    }

    /// The next tick, read `late` clocks of the core after it.
    fn tick(&mut self, late: u32) -> Taken<RING> {
        while !pac::TIM8.sr().read().uif() {}
        pac::TIM8.sr().write(|w| {
            w.0 = u32::MAX;
            w.set_uif(false);
        });
        if late > 0 {
            cortex_m::asm::delay(late);
        }
        let (sample, progress) = encoder::sample();
        self.ring.take(sample, progress, |index| EDGES.word(index))
    }
}

/// An encoder that turns evenly: every edge has its time, to a clock, and its count.
pub fn uniform(clocks: u16) {
    let _generator = Generator::start(clocks);
    let mut inputs = Inputs::start();
    let mut spacing = Spacing::new(clocks.into());
    let mut moved = 0;
    for _ in 0..TICKS {
        let taken = inputs.tick(0);
        defmt::assert!(!taken.overrun, "edges were lost");
        spacing.take(EDGES.slices(&taken.span));
        moved += taken.moved;
    }
    let expected = TICKS * (PERIOD / u32::from(clocks));
    defmt::info!(
        "{=u16} clocks apart: {=u32} edges, {=i32} counts, distances within {=u32} clocks",
        clocks,
        spacing.edges,
        moved,
        spacing.worst
    );
    defmt::assert!(
        spacing.worst <= EXACT,
        "an edge has a wrong time, or is missing"
    );
    defmt::assert_eq!(moved.unsigned_abs(), spacing.edges, "counts are not edges");
    defmt::assert!(moved > 0, "it counts down: A and B are interchanged");
    defmt::assert!(spacing.edges.abs_diff(expected) <= 1, "counts are missing");
}

/// An encoder that turns round: counts up, then down, and the edges stay where they belong.
pub fn reversal(clocks: u16) {
    let mut generator = Generator::start(clocks);
    let mut inputs = Inputs::start();
    let mut spacing = Spacing::new(clocks.into());
    let mut reversal = Reversal::new((PERIOD / u32::from(clocks)) as i32);
    for tick in 0..TICKS {
        // Anywhere in a tick but where it is read.
        if tick == TICKS / 2 {
            cortex_m::asm::delay(FAST_TIMER_HZ / TICK_HZ / 3);
            generator.reverse();
        }
        let taken = inputs.tick(0);
        defmt::assert!(!taken.overrun, "edges were lost");
        spacing.take(EDGES.slices(&taken.span));
        reversal.take(taken.moved);
    }
    defmt::info!(
        "{=u16} clocks apart, once reversed: distances within {=u32} clocks, {=u32} ticks do not fit",
        clocks,
        spacing.worst,
        reversal.faults
    );
    defmt::assert!(reversal.is_right(), "the counts do not follow the reversal");
    defmt::assert!(
        spacing.worst <= EXACT,
        "an edge has a wrong time, or is missing"
    );
}

/// A reader that is late by up to half a tick finds count and time of the tick.
pub fn late_readers() {
    const SPACING: u16 = 840;
    let _generator = Generator::start(SPACING);
    let mut inputs = Inputs::start();
    let mut last: Option<Taken<RING>> = None;
    for tick in 0..TICKS {
        let late = tick % 8 * (FAST_TIMER_HZ / TICK_HZ / 16);
        let taken = inputs.tick(late);
        if let Some(last) = last {
            let period = taken.sampled_at.wrapping_sub(last.sampled_at);
            defmt::assert_eq!(period, PERIOD, "the sampling instant is not the tick");
            let expected = (PERIOD / u32::from(SPACING)) as i32;
            defmt::assert!(
                (taken.moved - expected).abs() <= 1,
                "the count is not of the tick"
            );
        }
        last = Some(taken);
    }
}
