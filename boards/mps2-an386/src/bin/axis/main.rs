//! The axis firmware with a simulated machine in place of encoder and drive.
//!
//! ```text
//!           period                   priority  interrupt
//! TIMER1    |      k'     |      k'+1    high  control tick k: takes inputs k, gives outputs k
//! TIMER0    | k         | k+1          middle  machine step k+1: takes outputs k, gives inputs k+1
//! DUALTIMER                                    embassy's time
//! SPARE30                              lowest  pended by the tick: wakes the telemetry task
//! thread                                       requests, telemetry, log; idles in WFE
//! ```
//!
//! The run is the standard move there and back, or a scenario that is built in (`scenario=NAME`). At its end the digest of all inputs and outputs is
//! logged, which is that of the host's simulation of the same run.
//!
//! Both timers have the same period and the tick comes [`TICK_PHASE`] of it behind the machine. Where
//! the machine is not done by then the tick counts as late, and the run fails.
//!
//! Arguments: `scenario=NAME`, and see [`leadscrew_app::options`].
#![no_std]
#![no_main]

mod machine;
mod thread;

use core::sync::atomic::AtomicU32;

use board_mps2_an386::handoff::{Giver, Handoff, Taker};
use board_mps2_an386::interrupts::{Interrupt, interrupt};
use board_mps2_an386::isr_cell::IsrCell;
use board_mps2_an386::timer::{TIMER0, TIMER1, Timer};
use board_mps2_an386::{CLOCK_HZ, arguments, exit_failure, time_driver};
use cortex_m::peripheral::NVIC;
use embassy_executor::Spawner;
use heapless::spsc::{Consumer, Producer, Queue};
use leadscrew::telemetry::Record;
use leadscrew_app::axis_control::{AxisControl, Request};
use leadscrew_app::options::Options;
use leadscrew_app::telemetry::{Plan, Ready};
use leadscrew_app::tick::{Counters, Runtime, TickTimer};
use leadscrew_hal_mock::scenario::{Scenario, built_in};
use static_cell::{ConstStaticCell, StaticCell};

use machine::{Job, MachineState, Panel, Plant};

/// The tick's distance behind the machine step, in 1/8 of the period.
const TICK_PHASE: u32 = 6;
/// A tick has to end within this part of the period, in 1/8: before the next machine step.
const TICK_BUDGET: u32 = 1;
/// Records that telemetry may be behind.
const QUEUE: usize = 64;
/// Requests that may wait.
const REQUEST_QUEUE: usize = 8;

const PRIORITY_TICK: u8 = 0x40;
const PRIORITY_MACHINE: u8 = 0x80;
const PRIORITY_TIME: u8 = 0xa0;
const PRIORITY_TELEMETRY: u8 = 0xe0;

static TICK: IsrCell<TickState> = IsrCell::empty();
static MACHINE: IsrCell<MachineState> = IsrCell::empty();
static COUNTERS: Counters = Counters::new();
static READY: Ready = Ready::new();
/// Requests that did not fit.
static REFUSED: AtomicU32 = AtomicU32::new(0);

struct TickState {
    runtime: Runtime<AxisControl<Plant>>,
    inputs: Taker<Plant>,
    outputs: Giver<Record>,
    ticks_left: u32,
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

/// The machine, one step a period.
#[interrupt]
fn TIMER0() {
    TIMER0.acknowledge();
    MACHINE.with(MachineState::step);
}

/// The control tick.
#[interrupt]
fn TIMER1() {
    TIMER1.acknowledge();
    TICK.with(|state| {
        if state.ticks_left == 0 {
            // Pended already when the timers were stopped.
            return;
        }
        let runtime = &mut state.runtime;
        let clock = TickClock(&TIMER1);
        let record = state
            .inputs
            .take(|inputs| runtime.run(&clock, Some(inputs)))
            .unwrap_or_else(|| runtime.run(&clock, None));
        // Not taken: the machine did not run; it has no inputs for the next tick either, which counts.
        let _ = state.outputs.give(|place| *place = record);
        state.ticks_left -= 1;
        if state.ticks_left == 0 {
            TIMER0.stop();
            TIMER1.stop();
        }
    });
    NVIC::pend(Interrupt::SPARE30);
}

/// The tick wakes nobody itself.
#[interrupt]
fn SPARE30() {
    READY.signal(());
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let (options, scenario) = options();
    let made = match scenario {
        Some(scenario) => Job::scenario(scenario),
        None => Job::standard_move(&options),
    };
    let Ok(mut job) = made else {
        defmt::error!("the scenario does not fit the machine");
        exit_failure()
    };
    let tick_hz = job.tick_hz as u32;
    let period = (CLOCK_HZ + tick_hz / 2) / tick_hz;
    job.ticks = options.ticks.unwrap_or(job.ticks);
    let ticks = job.ticks;
    let (requests, records, panel) = wire(job, period);
    // A plant with its troubles takes a while to be put in its place.
    time_driver::start();
    unmask_interrupts();
    let plan = Plan {
        ticks,
        report_every: tick_hz,
    };
    let desk = match panel {
        Panel::Script(script) => {
            spawner.spawn(thread::operate(requests, script).expect("spawned once"));
            None
        }
        Panel::Desk(desk) => Some((desk, requests)),
    };
    spawner.spawn(thread::report(records, plan, desk).expect("spawned once"));
    defmt::info!("axis: {=u32} ticks at {=u32} Hz", ticks, tick_hz);
    TIMER0.start(period, period);
    TIMER1.start(period, period + period / 8 * TICK_PHASE);
}

/// Words of the command line, and the scenario that they name.
fn options() -> (Options, Option<&'static Scenario<'static>>) {
    let mut options = Options::default();
    let mut scenario = None;
    let result = arguments(|word| {
        if let Some(name) = word.strip_prefix("scenario=") {
            scenario = built_in(name);
            if scenario.is_none() {
                defmt::error!("argument {=str}: there is no such scenario", word);
                exit_failure();
            }
            return Ok(());
        }
        options
            .apply(word)
            .inspect_err(|error| defmt::error!("argument {=str}: {}", word, error))
    });
    if result.is_err() {
        exit_failure();
    }
    (options, scenario)
}

/// Hands every interrupt its state; gives the ends of the queues that thread mode holds.
fn wire(job: Job, period: u32) -> (Producer<'static, Request>, Consumer<'static, Record>, Panel) {
    static INPUTS: StaticCell<Handoff<Plant>> = StaticCell::new();
    static OUTPUTS: StaticCell<Handoff<Record>> = StaticCell::new();
    static RECORDS: StaticCell<Queue<Record, QUEUE>> = StaticCell::new();
    static REQUESTS: ConstStaticCell<Queue<Request, REQUEST_QUEUE>> =
        ConstStaticCell::new(Queue::new());

    let (to_tick, from_machine) = INPUTS.init(Handoff::new(job.plant)).split();
    let (to_machine, from_tick) = OUTPUTS.init(Handoff::new(Record::default())).split();
    let (producer, consumer) = RECORDS.init(Queue::new()).split();
    let (ask, asked) = REQUESTS.take().split();
    let control = AxisControl::new(job.axis, asked, &REFUSED);
    let tick = TickState {
        runtime: Runtime::new(control, producer, &COUNTERS, period / 8 * TICK_BUDGET),
        inputs: from_machine,
        outputs: to_machine,
        ticks_left: job.ticks,
    };
    let machine = MachineState::new(to_tick, from_tick, job.fate);
    assert!(
        TICK.put(tick) && MACHINE.put(machine),
        "interrupts are masked"
    );
    (ask, consumer, job.panel)
}

fn unmask_interrupts() {
    let mut core = cortex_m::Peripherals::take().expect("main runs once");
    let lines = [
        (Interrupt::TIMER1, PRIORITY_TICK),
        (Interrupt::TIMER0, PRIORITY_MACHINE),
        (Interrupt::DUALTIMER, PRIORITY_TIME),
        (Interrupt::SPARE30, PRIORITY_TELEMETRY),
    ];
    for (line, priority) in lines {
        // SAFETY: all critical sections of the program mask by PRIMASK, so they hold at any priority;
        // the handlers share only what `Handoff`, `IsrCell`, atomics and the queue's two ends protect.
        unsafe {
            core.NVIC.set_priority(line, priority);
            NVIC::unmask(line);
        }
    }
}
