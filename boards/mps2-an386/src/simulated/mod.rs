//! The axis on a machine that is simulated in the guest: interrupts, and what they share.
//!
//! ```text
//!           period                   priority  interrupt
//! TIMER1    |      k'     |      k'+1    high  control tick k: takes inputs k, gives outputs k
//! TIMER0    | k         | k+1          middle  machine step k+1: takes outputs k, gives inputs k+1
//! DUALTIMER                                    embassy's time
//! SPARE30                              lowest  pended by the tick: wakes thread mode
//! ```
//!
//! Both timers have the same period and the tick comes [`TICK_PHASE`] of it behind the machine. Where the machine is not
//! done by then the tick counts as late.
//!
//! A program wires everything, unmasks, starts, and forwards the lines `TIMER0`, `TIMER1` and `SPARE30` to
//! [`machine_interrupt`], [`tick_interrupt`] and [`report_interrupt`].

mod machine;

use board_common::isr_cell::IsrCell;
use cortex_m::peripheral::NVIC;
use heapless::spsc::{Consumer, Queue};
use leadscrew::telemetry::Record;
use leadscrew_app::axis_control::AxisControl;
use leadscrew_app::report::Report;
use leadscrew_app::store::Interlock;
use leadscrew_app::telemetry::Ready;
use leadscrew_app::tick::{Counters, Counts, Runtime, TickTimer};
use leadscrew_hal_mock::scenario::Fate;
use static_cell::StaticCell;

pub use machine::{MachineState, Plant};

use crate::CLOCK_HZ;
use crate::handoff::{Giver, Handoff, Taker};
use crate::interrupts::Interrupt;
use crate::timer::{TIMER0, TIMER1, Timer};
use crate::uart::Uart;

/// The tick's distance behind the machine step, in 1/8 of the period.
pub const TICK_PHASE: u32 = 6;
/// A tick has to end within this part of the period, in 1/8: before the next machine step.
const TICK_BUDGET: u32 = 1;
/// Ticks that thread mode may be behind.
const QUEUE: usize = 64;

/// Priorities of the interrupts; the lower, the more urgent.
pub mod priority {
    /// The control tick.
    pub const TICK: u8 = 0x40;
    /// The machine.
    pub const MACHINE: u8 = 0x80;
    /// Embassy's time.
    pub const TIME: u8 = 0xa0;
    /// UARTs.
    pub const UART: u8 = 0xc0;
    /// Waking thread mode.
    pub const REPORT: u8 = 0xe0;
}

static TICK: IsrCell<TickState> = IsrCell::empty();
/// The machine's state.
pub static MACHINE: IsrCell<MachineState> = IsrCell::empty();
/// Counts of the tick.
pub static COUNTERS: Counters = Counters::new();
/// "There are records."
pub static READY: Ready = Ready::new();
/// Keeps axis and store apart.
pub static INTERLOCK: Interlock = Interlock::new();

/// What is simulated.
pub struct Job {
    /// The machine, with its board or alone.
    pub plant: Plant,
    /// The axis on it, which is to count in [`COUNTERS`] and to heed [`INTERLOCK`].
    pub control: AxisControl<Plant>,
    /// What is done to the plant.
    pub fate: Fate<'static>,
}

struct TickState {
    runtime: Runtime<AxisControl<Plant>>,
    inputs: Taker<Plant>,
    outputs: Giver<Record>,
    ticks_left: Option<u32>,
}

struct TickClock(&'static Timer);

impl TickTimer for TickClock {
    fn since_due(&self) -> u32 {
        self.0.since_reload()
    }

    fn is_due_again(&self) -> bool {
        self.0.is_due()
    }
}

/// Clocks of a tick.
pub const fn period(tick_hz: u32) -> u32 {
    (CLOCK_HZ + tick_hz / 2) / tick_hz
}

/// Hands every interrupt its state; to be called once, with interrupts masked. After `ticks` the timers stop.
/// Gives what the ticks leave.
pub fn wire(job: Job, period: u32, ticks: Option<u32>) -> Consumer<'static, Report> {
    static INPUTS: StaticCell<Handoff<Plant>> = StaticCell::new();
    static OUTPUTS: StaticCell<Handoff<Record>> = StaticCell::new();
    static REPORTS: StaticCell<Queue<Report, QUEUE>> = StaticCell::new();

    let (to_tick, from_machine) = INPUTS.init(Handoff::new(job.plant)).split();
    let (to_machine, from_tick) = OUTPUTS.init(Handoff::new(Record::default())).split();
    let (producer, reports) = REPORTS.init(Queue::new()).split();
    let tick = TickState {
        runtime: Runtime::new(job.control, producer, &COUNTERS, period / 8 * TICK_BUDGET),
        inputs: from_machine,
        outputs: to_machine,
        ticks_left: ticks,
    };
    let machine = MachineState::new(to_tick, from_tick, job.fate);
    assert!(
        TICK.put(tick) && MACHINE.put(machine),
        "interrupts are masked"
    );
    reports
}

/// Logs what the tick counted.
pub fn log(counts: &Counts) {
    defmt::info!(
        "ticks {=u32} late {=u32} overlong {=u32} lost records {=u32}",
        counts.ticks,
        counts.late,
        counts.overlong,
        counts.lost_records
    );
    defmt::info!(
        "worst start {=u32} clocks, worst end {=u32} clocks after due",
        counts.worst_start,
        counts.worst_end
    );
}

/// Unmasks the lines of the simulated axis and those of `uarts`, which have to be open.
///
/// # Panics
/// On the second call.
pub fn unmask(uarts: &[&Uart]) {
    let mut core = cortex_m::Peripherals::take().expect("main runs once");
    let lines = [
        (Interrupt::TIMER1, priority::TICK),
        (Interrupt::TIMER0, priority::MACHINE),
        (Interrupt::DUALTIMER, priority::TIME),
        (Interrupt::SPARE30, priority::REPORT),
    ];
    let uarts = uarts.iter().flat_map(|uart| uart.lines());
    let uarts = uarts.map(|line| (line, priority::UART));
    for (line, priority) in lines.into_iter().chain(uarts) {
        // SAFETY: all critical sections of the program mask by PRIMASK, so they hold at any priority; the handlers
        // share only what `Handoff`, `IsrCell`, atomics and the two ends of queues protect.
        unsafe {
            core.NVIC.set_priority(line, priority);
            NVIC::unmask(line);
        }
    }
}

/// Starts machine and tick.
pub fn start(period: u32) {
    TIMER0.start(period, period);
    TIMER1.start(period, period + period / 8 * TICK_PHASE);
}

/// The machine, one step a period.
pub fn machine_interrupt() {
    TIMER0.acknowledge();
    MACHINE.with(MachineState::step);
}

/// The control tick.
pub fn tick_interrupt() {
    TIMER1.acknowledge();
    TICK.with(TickState::run);
    NVIC::pend(Interrupt::SPARE30);
}

/// The tick wakes nobody itself.
pub fn report_interrupt() {
    READY.signal(());
}

impl TickState {
    fn run(&mut self) {
        if self.ticks_left == Some(0) {
            // Pended already when the timers were stopped.
            return;
        }
        let runtime = &mut self.runtime;
        let clock = TickClock(&TIMER1);
        let report = self
            .inputs
            .take(|inputs| runtime.run(&clock, Some(inputs)))
            .unwrap_or_else(|| runtime.run(&clock, None));
        // Not taken: the machine did not run; it has no inputs for the next tick either, which counts.
        let _ = self.outputs.give(|place| *place = report.record);
        if let Some(left) = &mut self.ticks_left {
            *left -= 1;
            if *left == 0 {
                TIMER0.stop();
                TIMER1.stop();
            }
        }
    }
}
