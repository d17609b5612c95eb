//! The control tick: TIM8 gives the instant, its interrupt does the work.
//!
//! ```text
//! TIM8 update ─┬─ TRGO ─► TIM2, TIM5: count and time of this instant
//!              └─ interrupt ─► sample ─► Runtime ─► converter, lines ─► watchdog ─► report interrupt ─► thread mode
//! ```
//!
//! The handler has the highest priority but for the latches. Nothing in it waits but the converter, for a bounded time.

use board_common::isr_cell::IsrCell;
use cortex_m::peripheral::NVIC;
use embassy_stm32::interrupt;
use embassy_stm32::pac;
use embassy_stm32::pac::timer::vals::{Mms, Urs};
use heapless::spsc::{Consumer, Queue};
use leadscrew_app::axis_control::AxisControl;
use leadscrew_app::report::Report;
use leadscrew_app::safe_state::feeding::{Feeding, Meal};
use leadscrew_app::safe_state::reason::Reason;
use leadscrew_app::store::Interlock;
use leadscrew_app::telemetry::Ready;
use leadscrew_app::tick::{Counters, Runtime, TickTimer};
use leadscrew_app::tick_period::TickPeriod;

use crate::clocks::TIMER_HZ;
use crate::converter::Output;
use crate::machine::Machine;
use crate::memory::REPORTS;
use crate::{encoder, flash, lines, reset_record, safe_state, stack, watchdog};

/// A tick has to end within this part of its period, in 1/8.
const BUDGET: u32 = 6;

static TICK: IsrCell<TickState> = IsrCell::empty();
/// Counts of the tick.
pub static COUNTERS: Counters = Counters::new();
/// "There are reports."
pub static READY: Ready = Ready::new();
/// Keeps axis and store apart.
pub static INTERLOCK: Interlock = Interlock::new();

/// What the tick works with.
pub struct TickState {
    runtime: Runtime<&'static mut AxisControl<Machine>>,
    machine: Machine,
    output: Output,
    feeding: Feeding,
    /// Clocks of TIM5 from tick to tick.
    period: u32,
    /// Time of the last tick; none before the first.
    last: Option<u32>,
}

/// When the tick was due.
struct Due(u32);

impl TickTimer for Due {
    fn since_due(&self) -> u32 {
        encoder::now().wrapping_sub(self.0)
    }

    fn is_due_again(&self) -> bool {
        pac::TIM8.sr().read().uif()
    }
}

/// Hands the interrupt its state; to be called once, with the interrupt masked. Gives what the ticks leave.
pub fn wire(
    control: &'static mut AxisControl<Machine>,
    machine: Machine,
    mut output: Output,
    queue: &'static mut Queue<Report, REPORTS>,
    tick_hz: f64,
) -> Consumer<'static, Report> {
    let (producer, reports) = queue.split();
    let period = (f64::from(TIMER_HZ) / tick_hz) as u32;
    let budget = period / 8 * BUDGET;
    output.pace(tick_hz);
    let state = TickState {
        runtime: Runtime::new(control, producer, &COUNTERS, budget),
        machine,
        output,
        feeding: Feeding::new(),
        period,
        last: None,
    };
    adopt(state);
    reports
}

/// Gives the interrupt, which has to be masked, its state.
pub fn adopt(state: TickState) {
    // Masked, so nobody else has it.
    TICK.put(state);
}

/// Sets the timer up and starts it.
pub fn start(period: TickPeriod) {
    let timer = pac::TIM8;
    timer.psc().write_value(period.divider - 1);
    timer.arr().write(|w| w.set_arr(period.counts - 1));
    // The generated update takes the divider over and is no tick.
    timer.cr1().write(|w| w.set_urs(Urs::COUNTER_ONLY));
    timer.egr().write(|w| w.set_ug(true));
    timer.sr().write(|_| {});
    timer.cr2().write(|w| w.set_mms(Mms::UPDATE));
    timer.dier().write(|w| w.set_uie(true));
    timer.cr1().modify(|w| w.set_cen(true));
}

/// No tick comes any more.
pub fn stop() {
    pac::TIM8.cr1().modify(|w| w.set_cen(false));
    pac::TIM8.dier().write(|_| {});
}

#[interrupt]
fn TIM8_UP_TIM13() {
    // A zero clears a flag, and a one leaves it. First: the next update flags anew.
    pac::TIM8.sr().write(|w| {
        w.0 = u32::MAX;
        w.set_uif(false);
    });
    TICK.with(TickState::run);
    NVIC::pend(interrupt::SDIO);
}

/// The tick wakes nobody itself. The line is of a peripheral that this board does not use.
#[interrupt]
fn SDIO() {
    READY.signal(());
}

impl TickState {
    fn run(&mut self) {
        let (sample, progress) = encoder::sample();
        // `cargo xtask no-panic` has to find it.
        #[cfg(feature = "planted-panic")]
        assert!(sample.time != 0);
        let missed = self.missed(sample.time);
        self.machine.sample(sample, progress, missed);
        let Self {
            runtime,
            machine,
            output,
            ..
        } = self;
        runtime.note_missed(missed);
        let mut readback = None;
        runtime.run_and(&Due(sample.time), Some(&*machine), |report| {
            let outputs = report.record.put_out();
            lines::put_out(&outputs);
            let is_off = !(outputs.enabled || outputs.brake_released);
            readback = Some(output.put(outputs.command, is_off));
        });
        machine.readback = readback;
        if !stack::is_whole() {
            safe_state::fail(Reason::StackOverflow);
        }
        self.feed();
    }

    /// The first starving tick but one writes a record, some 20 µs long: it is late as it is.
    fn feed(&mut self) {
        match self.feeding.after_tick(self.runtime.was_in_time()) {
            Meal::Feed => watchdog::feed(),
            Meal::FeedAgain => {
                reset_record::forget();
                watchdog::feed();
            }
            Meal::Starve => {}
            Meal::StarveFirst(reason) => reset_record::keep(reason),
        }
    }

    /// Ticks that did not run before this one.
    fn missed(&mut self, time: u32) -> u16 {
        let Some(last) = self.last.replace(time) else {
            return 0;
        };
        // Asked in every tick: it is of the time since the last one.
        let has_stalled = flash::take_stall();
        let passed = time.wrapping_sub(last).wrapping_add(self.period / 2);
        if has_stalled || passed < 2 * self.period {
            return 0;
        }
        // No period is zero; the compiler does not know that, and a division by zero would be a panic in the tick.
        let periods = passed.checked_div(self.period).unwrap_or(0);
        u16::try_from(periods.saturating_sub(1)).unwrap_or(u16::MAX)
    }
}
