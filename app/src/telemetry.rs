//! The telemetry task: takes the tick's records in thread mode, sums them up, reports.

use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use heapless::spsc::Consumer;

use crate::tick::{Counters, Counts};

/// "There are records": signalled by an interrupt that the tick pends, since the tick wakes nobody.
pub type Ready = Signal<CriticalSectionRawMutex, ()>;

/// What becomes of the records.
pub trait Sink {
    /// What the tick left.
    type Record;

    /// Takes one record, in order.
    fn record(&mut self, record: &Self::Record);

    /// Called about every `report_every` ticks.
    fn progress(&mut self, counts: &Counts);
}

/// How long to run, and how often to report.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Ticks to the end of the run.
    pub ticks: u32,
    /// Ticks between two calls of [`Sink::progress`].
    pub report_every: u32,
}

/// Feeds `sink` until the run has had its ticks; gives the counts at the end.
pub async fn run<S: Sink>(
    sink: &mut S,
    records: &mut Consumer<'static, S::Record>,
    ready: &Ready,
    counters: &Counters,
    plan: Plan,
) -> Counts {
    let mut next_report = plan.report_every;
    loop {
        ready.wait().await;
        // Counted before the queue is emptied: at the last tick nothing can come behind.
        let counts = counters.read();
        while let Some(record) = records.dequeue() {
            sink.record(&record);
        }
        if counts.ticks >= plan.ticks {
            return counts;
        }
        if counts.ticks >= next_report {
            sink.progress(&counts);
            next_report = next_report.saturating_add(plan.report_every);
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::boxed::Box;
    use std::vec::Vec;

    use embassy_futures::block_on;
    use embassy_futures::join::join;
    use embassy_futures::yield_now;
    use heapless::spsc::Queue;

    use super::*;
    use crate::tick::{Control, Runtime, TickTimer};

    struct Echo;

    impl Control for Echo {
        type Inputs = u32;
        type Record = u32;

        fn step(&mut self, inputs: &u32) -> u32 {
            *inputs
        }

        fn missed(&mut self) -> u32 {
            0
        }
    }

    struct Still;

    impl TickTimer for Still {
        fn since_due(&self) -> u32 {
            0
        }

        fn is_due_again(&self) -> bool {
            false
        }
    }

    #[derive(Default)]
    struct Collect {
        records: Vec<u32>,
        progress: Vec<u32>,
    }

    impl Sink for Collect {
        type Record = u32;

        fn record(&mut self, record: &u32) {
            self.records.push(*record);
        }

        fn progress(&mut self, counts: &Counts) {
            self.progress.push(counts.ticks);
        }
    }

    #[test]
    fn every_record_arrives_in_order_and_the_run_ends_at_its_last_tick() {
        static COUNTERS: Counters = Counters::new();
        let queue: &'static mut Queue<u32, 8> = Box::leak(Box::new(Queue::new()));
        let (producer, mut consumer) = queue.split();
        let mut runtime = Runtime::new(Echo, producer, &COUNTERS, 1);
        let ready = Ready::new();
        let mut sink = Collect::default();
        let plan = Plan {
            ticks: 25,
            report_every: 10,
        };
        let ticks = async {
            for tick in 0..25 {
                runtime.run(&Still, Some(&tick));
                ready.signal(());
                // The task is let in only at every third tick: one signal stands for several records.
                if tick % 3 == 0 {
                    yield_now().await;
                }
            }
        };
        let telemetry = run(&mut sink, &mut consumer, &ready, &COUNTERS, plan);
        let ((), counts) = block_on(join(ticks, telemetry));
        assert_eq!(sink.records, (0..25).collect::<Vec<_>>());
        assert_eq!(sink.progress.len(), 2);
        assert!(counts.is_clean());
        assert_eq!(counts.ticks, 25);
    }
}
