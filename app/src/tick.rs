//! The control tick: a plain function that the board's timer interrupt calls.

use core::sync::atomic::{AtomicU32, Ordering};

use heapless::spsc::Producer;

use crate::queues::enqueue;

/// What the tick computes: the axis, or in a test something simpler.
pub trait Control {
    /// What the board saw up to this tick.
    type Inputs;
    /// What the tick gives: to the board what it is to do until the next tick, to telemetry a record.
    type Record: Copy;

    /// One tick; bounded time, no blocking.
    fn step(&mut self, inputs: &Self::Inputs) -> Self::Record;

    /// A tick without inputs: safe for the board.
    fn missed(&mut self) -> Self::Record;

    /// The tick that [`Self::step`] was called for ended after its budget.
    fn overlong(&mut self) {}
}

/// One that lies elsewhere: what it is moved through has no room for it.
impl<C: Control> Control for &mut C {
    type Inputs = C::Inputs;
    type Record = C::Record;

    fn step(&mut self, inputs: &C::Inputs) -> C::Record {
        C::step(self, inputs)
    }

    fn missed(&mut self) -> C::Record {
        C::missed(self)
    }

    fn overlong(&mut self) {
        C::overlong(self);
    }
}

/// The timer whose interrupt is the tick.
pub trait TickTimer {
    /// Timer clocks since the tick was due; starts again at the next one.
    fn since_due(&self) -> u32;

    /// Whether the next tick is due already.
    fn is_due_again(&self) -> bool;
}

/// Counts of the tick, for a reader in another context; they saturate nowhere: 2³² ticks are 29 h at
/// 40 kHz, then they wrap.
#[derive(Debug, Default)]
pub struct Counters {
    ticks: AtomicU32,
    late: AtomicU32,
    overlong: AtomicU32,
    lost_records: AtomicU32,
    worst_start: AtomicU32,
    worst_end: AtomicU32,
}

/// [`Counters`] at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counts {
    /// Ticks that ran.
    pub ticks: u32,
    /// Ticks whose inputs were not there, and those that did not run at all.
    pub late: u32,
    /// Ticks that ended after their budget.
    pub overlong: u32,
    /// Records that found the queue full.
    pub lost_records: u32,
    /// Latest start of a tick after it was due, in timer clocks.
    pub worst_start: u32,
    /// Latest end of a tick after it was due, in timer clocks.
    pub worst_end: u32,
}

impl Counters {
    /// All zero.
    pub const fn new() -> Self {
        Self {
            ticks: AtomicU32::new(0),
            late: AtomicU32::new(0),
            overlong: AtomicU32::new(0),
            lost_records: AtomicU32::new(0),
            worst_start: AtomicU32::new(0),
            worst_end: AtomicU32::new(0),
        }
    }

    /// The counts now; read while ticks run, each is right by itself.
    pub fn read(&self) -> Counts {
        Counts {
            ticks: self.ticks.load(Ordering::Acquire),
            late: self.late.load(Ordering::Relaxed),
            overlong: self.overlong.load(Ordering::Relaxed),
            lost_records: self.lost_records.load(Ordering::Relaxed),
            worst_start: self.worst_start.load(Ordering::Relaxed),
            worst_end: self.worst_end.load(Ordering::Relaxed),
        }
    }
}

impl Counts {
    /// Whether every tick ran in time on inputs of its own and was reported.
    pub fn is_clean(&self) -> bool {
        self.late == 0 && self.overlong == 0 && self.lost_records == 0
    }
}

/// Only the tick writes, so a load and a store are enough.
fn add(counter: &AtomicU32, number: u32) {
    let value = counter.load(Ordering::Relaxed);
    counter.store(value.wrapping_add(number), Ordering::Release);
}

fn add_one(counter: &AtomicU32) {
    add(counter, 1);
}

fn keep_worst(counter: &AtomicU32, value: u32) {
    if value > counter.load(Ordering::Relaxed) {
        counter.store(value, Ordering::Relaxed);
    }
}

/// State of the tick interrupt.
pub struct Runtime<C: Control + 'static> {
    control: C,
    records: Producer<'static, C::Record>,
    counters: &'static Counters,
    budget: u32,
    has_missed: bool,
    was_in_time: bool,
}

impl<C: Control> Runtime<C> {
    /// `budget`: timer clocks after it was due by which a tick has to end.
    pub fn new(
        control: C,
        records: Producer<'static, C::Record>,
        counters: &'static Counters,
        budget: u32,
    ) -> Self {
        Self {
            control,
            records,
            counters,
            budget,
            has_missed: false,
            was_in_time: false,
        }
    }

    /// Whether the last tick had its inputs, ended within its budget and came right after the one before: what a watchdog may be
    /// fed by.
    #[inline]
    pub const fn was_in_time(&self) -> bool {
        self.was_in_time
    }

    /// Counts ticks that did not run before the one that comes, for a board whose inputs are there whenever it looks: what is late
    /// there is the tick itself. The axis is told of them by its inputs.
    #[inline]
    pub fn note_missed(&mut self, missed: u16) {
        if missed > 0 {
            add(&self.counters.late, missed.into());
            self.has_missed = true;
        }
    }

    /// One tick. `inputs` is `None` where they did not come in time: counted as late.
    pub fn run(&mut self, timer: &impl TickTimer, inputs: Option<&C::Inputs>) -> C::Record {
        self.run_and(timer, inputs, |_| {})
    }

    /// The same with `put_out`, which does what the record says and is part of the tick: a tick whose output comes too late is
    /// overlong.
    #[inline]
    pub fn run_and(
        &mut self,
        timer: &impl TickTimer,
        inputs: Option<&C::Inputs>,
        put_out: impl FnOnce(&C::Record),
    ) -> C::Record {
        keep_worst(&self.counters.worst_start, timer.since_due());
        let record = if let Some(inputs) = inputs {
            self.control.step(inputs)
        } else {
            add_one(&self.counters.late);
            self.control.missed()
        };
        put_out(&record);
        if enqueue(&mut self.records, record).is_err() {
            add_one(&self.counters.lost_records);
        }
        let has_missed = core::mem::take(&mut self.has_missed);
        self.was_in_time = self.check_end(timer) && inputs.is_some() && !has_missed;
        // Last: a reader that sees tick n counted sees all that was counted in it.
        add_one(&self.counters.ticks);
        record
    }

    /// Whether the tick ended in time.
    fn check_end(&mut self, timer: &impl TickTimer) -> bool {
        let end = timer.since_due();
        let is_overlong = timer.is_due_again() || end > self.budget;
        if is_overlong {
            add_one(&self.counters.overlong);
            self.control.overlong();
        }
        keep_worst(&self.counters.worst_end, end);
        !is_overlong
    }
}

#[cfg(test)]
mod tests;
