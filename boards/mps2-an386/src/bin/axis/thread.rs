//! Thread mode: the person at the panel, and the report.

use core::sync::atomic::{AtomicU32, Ordering};

use board_mps2_an386::simulated::{COUNTERS, MACHINE, READY, log};
use board_mps2_an386::{exit_failure, exit_success};
use embassy_time::{Instant, Timer};
use heapless::spsc::{Consumer, Producer};
use leadscrew::axis;
use leadscrew::telemetry::Record;
use leadscrew_app::axis_control::{Request, What};
use leadscrew_app::queues::Outcome;
use leadscrew_app::report::Report;
use leadscrew_app::telemetry::{self, Plan, Sink};
use leadscrew_app::tick::Counts;
use leadscrew_hal_mock::scenario::{Desk, Order, ScenarioError, Script};

/// Requests that did not fit, or that the axis did not take. Thread mode alone counts.
static REFUSED: AtomicU32 = AtomicU32::new(0);

fn note_refused(more: u32) {
    REFUSED.store(REFUSED.load(Ordering::Relaxed) + more, Ordering::Relaxed);
}

/// The person at the panel: enables the axis and hands over each move once the one before has begun.
#[embassy_executor::task]
pub async fn operate(mut requests: Producer<'static, Request>, script: Script) {
    let mut ask = |request| {
        note_refused(u32::from(requests.enqueue(request).is_err()));
    };
    ask(Request::now(What::Enable(true)));
    let mut begun = 1;
    for next in script.moves {
        while COUNTERS.read().ticks < begun {
            Timer::after_millis(1).await;
        }
        ask(Request {
            at: begun,
            ticket: 0,
            what: What::Axis(axis::Request::Queue {
                plan: next.profile,
                start: next.start,
            }),
        });
        // Not before the last setpoint of this one may another one wait.
        begun = next.start + next.profile.ticks();
    }
}

/// Follows the records to the end of the run and ends the program.
#[embassy_executor::task]
pub async fn report(
    mut reports: Consumer<'static, Report>,
    outcomes: Consumer<'static, Outcome>,
    plan: Plan,
    desk: Option<(Desk<'static>, Producer<'static, Request>)>,
) {
    let mut trace = Trace {
        records: 0,
        last: Record::default(),
        outcomes,
        desk,
    };
    trace.open();
    let counts = telemetry::run(&mut trace, &mut reports, &READY, &COUNTERS, plan).await;
    log(&counts);
    let digest = MACHINE.with(|state| {
        state.account();
        state.digest()
    });
    defmt::info!(
        "digest {=u64:016x} of {=u32} ticks",
        digest.unwrap_or(0),
        trace.records
    );
    let refused = REFUSED.load(Ordering::Relaxed);
    if counts.is_clean() && trace.records == plan.ticks && refused == 0 {
        exit_success();
    }
    defmt::error!(
        "failed: ticks were late, overlong or not recorded, or {=u32} requests refused",
        refused
    );
    exit_failure()
}

/// Follows the records, and asks what a scenario asks.
struct Trace {
    records: u32,
    last: Record,
    outcomes: Consumer<'static, Outcome>,
    desk: Option<(Desk<'static>, Producer<'static, Request>)>,
}

impl Trace {
    /// Asks what is due before the first tick.
    fn open(&mut self) {
        self.operate(|desk, send| desk.open(send));
    }

    fn operate(
        &mut self,
        work: impl FnOnce(&mut Desk<'static>, &mut dyn FnMut(Order, u32)) -> Result<(), ScenarioError>,
    ) {
        let Some((desk, requests)) = &mut self.desk else {
            return;
        };
        let mut refused = 0;
        let mut send = |order, at| {
            let what = match order {
                Order::Enable(enable) => What::Enable(enable),
                Order::Axis(request) => What::Axis(request),
                Order::Nothing => return,
            };
            refused += u32::from(
                requests
                    .enqueue(Request {
                        at,
                        ticket: 0,
                        what,
                    })
                    .is_err(),
            );
        };
        let planned = work(desk, &mut send);
        refused += u32::from(planned.is_err());
        note_refused(refused);
    }
}

impl Sink for Trace {
    type Record = Report;

    fn record(&mut self, report: &Report) {
        let record = &report.record;
        self.records += 1;
        self.last = *record;
        while let Some(outcome) = self.outcomes.dequeue() {
            note_refused(u32::from(outcome.result.is_err()));
        }
        self.operate(|desk, send| desk.follow(record, send));
    }

    fn progress(&mut self, counts: &Counts) {
        defmt::info!(
            "tick {=u32} at {=u64} us: count {=i32}, velocity {=i32} d/tick, late {=u32}",
            counts.ticks,
            Instant::now().as_micros(),
            self.last.count.cast_signed(),
            self.last.velocity >> 20,
            counts.late
        );
    }
}
