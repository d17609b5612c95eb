//! What an outer control or a second encoder gives: step/dir on TIM4, the second encoder on TIM3, the analog command on ADC 1.

use core::cell::UnsafeCell;

use embassy_stm32::interrupt;
use embassy_stm32::pac;
use embassy_stm32::pac::adc::vals::{Dds, SampleTime};
use embassy_stm32::pac::adccommon::vals::Adcpre;
use embassy_stm32::pac::dma::vals::Size;
use embassy_stm32::pac::timer::vals::{Dir, FilterValue, Sms, Ts};
use leadscrew::hal::{Capture, Latch};
use leadscrew::units::Command;
use leadscrew_app::edge_ring::Counter16;
use leadscrew_app::input_filter::InputFilter;

use crate::clocks::TIMER_HZ;
use crate::encoder::channel::{CH1, CH2, CH3};
use crate::encoder::{self, DIRECT};
use crate::{gpio, pins};

/// Fastest channel of a second encoder, Hz; and steps that are high and low for 0.5 µs pass, too.
const FASTEST_HZ: f64 = 300e3;
/// Line of the external interrupt of the direction, and its port B in the multiplexer.
const DIRECTION_LINE: usize = 7;
const PORT_B: u8 = 1;

/// Samples of the analog command that are averaged: 190 µs.
const SAMPLES: usize = 8;
/// Channel of the analog command.
const COMMAND_CHANNEL: u8 = 10;
/// Of DMA 2; ADC 1 is its channel 0.
const STREAM: usize = 0;
/// Reading of the converter at a command of zero.
const MIDDLE: i32 = 2048;

struct Samples(UnsafeCell<[u16; SAMPLES]>);

// SAFETY: the program only reads it, by volatile accesses; what writes is the DMA.
unsafe impl Sync for Samples {}

static ANALOG: Samples = Samples(UnsafeCell::new([MIDDLE as u16; SAMPLES]));

/// The references as of the tick.
pub struct References {
    steps: Counter16,
    step_count: u32,
    master: Counter16,
    master_count: u32,
    master_at: u32,
    master_edge_at: Option<u32>,
    master_index: Option<Latch>,
    analog: Command,
}

impl References {
    /// Sets the peripherals up and starts them.
    pub fn start() -> Self {
        start_steps();
        start_master();
        start_analog();
        Self {
            steps: Counter16::new(0),
            step_count: 0,
            master: Counter16::new(0),
            master_count: 0,
            master_at: encoder::now(),
            master_edge_at: None,
            master_index: None,
            analog: Command::ZERO,
        }
    }

    /// Reads all of them.
    pub fn sample(&mut self) {
        // The index first: one that comes meanwhile is not older than the count.
        // Read only where it is flagged: a read clears the flag, also that of one that came after it was looked at.
        let is_flagged = pac::TIM3.sr().read().ccif(CH3);
        let index = is_flagged.then(|| pac::TIM3.ccr(CH3).read().ccr());
        let (count, at) = (self.master_count, self.master_at);
        self.master_count = self.master.update(pac::TIM3.cnt().read().cnt());
        self.master_at = encoder::now();
        self.master_edge_at = self.newest_edge(count, at);
        self.master_index = index.map(|latched| Latch {
            count: self.master.at(latched),
            // Only the count is latched; nobody asks for a finer time of a spindle's index.
            time: self.master_at,
        });
        self.step_count = self.steps.update(pac::TIM4.cnt().read().cnt());
        self.analog = analog();
    }

    /// When the newest edge of the second encoder came, since it was at `count` at time `at`. Nothing stamps it: it is put half
    /// an edge's period before the count was read, where it is on average.
    fn newest_edge(&self, count: u32, at: u32) -> Option<u32> {
        let passed = self.master_count.wrapping_sub(count).cast_signed();
        let period = self.master_at.wrapping_sub(at);
        let age = period.checked_div(passed.unsigned_abs().wrapping_mul(2))?;
        Some(self.master_at.wrapping_sub(age))
    }

    /// The wrapping count of steps.
    pub const fn steps(&self) -> u32 {
        self.step_count
    }

    /// What the second encoder's inputs saw.
    pub const fn master(&self) -> Capture<'static> {
        Capture {
            count: self.master_count,
            sampled_at: self.master_at,
            last_edge_at: self.master_edge_at,
            edges: [&[], &[]],
            illegal: 0,
            overrun: false,
            touching: false,
            index: self.master_index,
            probe: None,
            home: None,
        }
    }

    /// The analog command, of full scale.
    pub const fn analog(&self) -> Command {
        self.analog
    }
}

/// By the rule of the encoder's own inputs ([`leadscrew_app::input_filter`]): the longest that takes at most half of the shortest
/// level, 32 clocks or 381 ns. It delays steps and counts by as much, all alike: no order between them changes, and a
/// step comes that much later after its direction, which is not filtered.
fn filter() -> FilterValue {
    let filter = InputFilter::longest(FASTEST_HZ, f64::from(TIMER_HZ));
    FilterValue::from_bits(filter.unwrap_or(InputFilter::shortest()).code())
}

fn start_steps() {
    let filter = filter();
    let timer = pac::TIM4;
    timer.arr().write(|w| w.set_arr(u16::MAX));
    timer.ccmr_input(0).write(|w| {
        w.set_ccs(CH1, DIRECT);
        w.set_icf(CH1, filter);
    });
    timer.smcr().write(|w| w.set_ts(Ts::TI1FP1));
    timer.smcr().modify(|w| w.set_sms(Sms::EXT_CLOCK_MODE));
    timer.cr1().write(|w| w.set_cen(true));
    let (bank, place) = (DIRECTION_LINE / 4, DIRECTION_LINE % 4);
    pac::SYSCFG
        .exticr(bank)
        .modify(|w| w.set_exti(place, PORT_B));
    pac::EXTI
        .rtsr(0)
        .modify(|w| w.set_line(DIRECTION_LINE, true));
    pac::EXTI
        .ftsr(0)
        .modify(|w| w.set_line(DIRECTION_LINE, true));
    pac::EXTI
        .imr(0)
        .modify(|w| w.set_line(DIRECTION_LINE, true));
    follow_direction();
}

/// Counts up where the direction's input is high. Outer controls hold it some microseconds before a step.
fn follow_direction() {
    let is_up = gpio::is_high(pins::DIRECTION);
    let direction = if is_up { Dir::UP } else { Dir::DOWN };
    pac::TIM4.cr1().modify(|w| w.set_dir(direction));
}

#[interrupt]
fn EXTI9_5() {
    // A one clears. First: a further edge flags anew.
    pac::EXTI.pr(0).write(|w| w.set_line(DIRECTION_LINE, true));
    follow_direction();
}

fn start_master() {
    let filter = filter();
    let timer = pac::TIM3;
    timer.arr().write(|w| w.set_arr(u16::MAX));
    timer.ccmr_input(0).write(|w| {
        w.set_ccs(CH1, DIRECT);
        w.set_ccs(CH2, DIRECT);
        w.set_icf(CH1, filter);
        w.set_icf(CH2, filter);
    });
    timer.ccmr_input(1).write(|w| {
        w.set_ccs(CH3 - 2, DIRECT);
        w.set_icf(CH3 - 2, filter);
    });
    timer.smcr().write(|w| w.set_sms(Sms::ENCODER_MODE_3));
    timer.ccer().write(|w| w.set_cce(CH3, true));
    timer.cr1().write(|w| w.set_cen(true));
}

fn start_analog() {
    let stream = pac::DMA2.st(STREAM);
    stream.par().write_value(pac::ADC1.dr().as_ptr() as u32);
    stream.m0ar().write_value(ANALOG.0.get() as u32);
    stream.ndtr().write(|w| w.set_ndt(SAMPLES as u16));
    stream.cr().write(|w| {
        w.set_psize(Size::BITS16);
        w.set_msize(Size::BITS16);
        w.set_minc(true);
        w.set_circ(true);
        w.set_en(true);
    });
    // 21 MHz; 36 are allowed.
    pac::ADC123_COMMON
        .ccr()
        .modify(|w| w.set_adcpre(Adcpre::DIV4));
    let adc = pac::ADC1;
    adc.smpr1()
        .write(|w| w.set_smp(usize::from(COMMAND_CHANNEL - 10), SampleTime::CYCLES480));
    adc.sqr3().write(|w| w.set_sq(0, COMMAND_CHANNEL));
    adc.cr2().write(|w| {
        w.set_adon(true);
        w.set_cont(true);
        w.set_dma(true);
        w.set_dds(Dds::CONTINUOUS);
    });
    // 3 µs from power to the first conversion.
    cortex_m::asm::delay(crate::clocks::CORE_HZ / 200_000);
    adc.cr2().modify(|w| w.set_swstart(true));
}

/// Mean of the last samples: ±10 V are 0 to 3.3 V at the pin.
fn analog() -> Command {
    let samples = ANALOG.0.get().cast::<u16>();
    let mut sum = 0;
    for index in 0..SAMPLES {
        // SAFETY: within the array and aligned; volatile, as the DMA writes.
        sum += i32::from(unsafe { samples.add(index).read_volatile() });
    }
    let above = sum - MIDDLE * SAMPLES as i32;
    // Full scale is MIDDLE·SAMPLES = 2¹⁴.
    Command::from_bits(above << (Command::FRAC_NBITS - 14))
}
