extern crate std;

use core::cell::Cell;
use std::boxed::Box;

use heapless::spsc::{Consumer, Queue};

use super::*;

struct Doubler;

impl Control for Doubler {
    type Inputs = u32;
    type Record = u32;

    fn step(&mut self, inputs: &u32) -> u32 {
        inputs * 2
    }

    fn missed(&mut self) -> u32 {
        u32::MAX
    }
}

/// Reads 3 when the tick starts and `end` when it ends.
struct Timer {
    end: u32,
    again: bool,
    started: Cell<bool>,
}

impl Timer {
    fn ending_at(end: u32) -> Self {
        Self {
            end,
            again: false,
            started: Cell::new(false),
        }
    }
}

impl TickTimer for Timer {
    fn since_due(&self) -> u32 {
        if self.started.replace(true) {
            self.end
        } else {
            3
        }
    }

    fn is_due_again(&self) -> bool {
        self.again
    }
}

fn runtime() -> (Runtime<Doubler>, Consumer<'static, u32>, &'static Counters) {
    let counters = Box::leak(Box::new(Counters::new()));
    let queue: &'static mut Queue<u32, 3> = Box::leak(Box::new(Queue::new()));
    let (producer, consumer) = queue.split();
    let runtime = Runtime::new(Doubler, producer, counters, 50);
    (runtime, consumer, counters)
}

#[test]
fn a_tick_in_time_is_clean_and_recorded() {
    let (mut runtime, mut records, counters) = runtime();
    assert_eq!(runtime.run(&Timer::ending_at(50), Some(&21)), 42);
    assert_eq!(records.dequeue(), Some(42));
    assert!(runtime.was_in_time());
    let counts = counters.read();
    assert!(counts.is_clean());
    assert_eq!(
        (counts.ticks, counts.worst_start, counts.worst_end),
        (1, 3, 50)
    );
}

#[test]
fn a_control_that_lies_elsewhere_is_told_of_a_tick_that_ended_too_late() {
    struct Told(bool);

    impl Control for Told {
        type Inputs = u32;
        type Record = u32;

        fn step(&mut self, inputs: &u32) -> u32 {
            *inputs
        }

        fn missed(&mut self) -> u32 {
            0
        }

        fn overlong(&mut self) {
            self.0 = true;
        }
    }

    let told = Box::leak(Box::new(Told(false)));
    let queue: &'static mut Queue<u32, 3> = Box::leak(Box::new(Queue::new()));
    let (producer, _records) = queue.split();
    let counters = Box::leak(Box::new(Counters::new()));
    let mut runtime = Runtime::new(told, producer, counters, 50);
    runtime.run(&Timer::ending_at(50), Some(&1));
    assert!(!runtime.control.0);
    runtime.run(&Timer::ending_at(51), Some(&1));
    assert!(runtime.control.0);
}

#[test]
fn missing_inputs_give_safe_outputs_and_count_as_late() {
    let (mut runtime, mut records, counters) = runtime();
    assert_eq!(runtime.run(&Timer::ending_at(5), None), u32::MAX);
    assert_eq!(records.dequeue(), Some(u32::MAX));
    assert_eq!(counters.read().late, 1);
    assert!(!runtime.was_in_time());
    assert!(!counters.read().is_clean());
}

#[test]
fn a_tick_over_its_budget_or_into_the_next_is_overlong() {
    let (mut runtime, _records, counters) = runtime();
    runtime.run(&Timer::ending_at(51), Some(&1));
    assert_eq!(counters.read().overlong, 1);
    assert!(!runtime.was_in_time());
    let wrapped = Timer {
        again: true,
        ..Timer::ending_at(4)
    };
    runtime.run(&wrapped, Some(&1));
    assert_eq!(counters.read().overlong, 2);
    assert!(!counters.read().is_clean());
}

#[test]
fn a_tick_whose_output_takes_too_long_is_overlong() {
    struct Clock(Cell<u32>);

    impl TickTimer for Clock {
        fn since_due(&self) -> u32 {
            self.0.get()
        }

        fn is_due_again(&self) -> bool {
            false
        }
    }

    let (mut runtime, mut records, counters) = runtime();
    let clock = Clock(Cell::new(5));
    let put = runtime.run_and(&clock, Some(&21), |record| clock.0.set(9 + record));
    assert_eq!((put, records.dequeue()), (42, Some(42)));
    let counts = counters.read();
    assert_eq!((counts.overlong, counts.worst_end), (1, 51));
    assert!(!runtime.was_in_time());
    clock.0.set(5);
    runtime.run_and(&clock, Some(&20), |record| clock.0.set(9 + record));
    assert!(runtime.was_in_time(), "one clock earlier");
}

#[test]
fn ticks_that_did_not_run_count_as_late_and_the_one_after_them_does_not_feed() {
    let (mut runtime, _records, counters) = runtime();
    let mut run = |missed| {
        runtime.note_missed(missed);
        runtime.run(&Timer::ending_at(5), Some(&1));
        (counters.read().late, runtime.was_in_time())
    };
    assert_eq!(run(0), (0, true));
    assert_eq!(run(3), (3, false));
    assert_eq!(run(0), (3, true));
    assert_eq!(run(u16::MAX), (3 + 0xffff, false));
}

#[test]
fn a_full_queue_is_counted_and_the_tick_goes_on() {
    let (mut runtime, _records, counters) = runtime();
    for _ in 0..3 {
        assert_eq!(runtime.run(&Timer::ending_at(5), Some(&1)), 2);
    }
    assert_eq!(counters.read().lost_records, 1);
    assert_eq!(counters.read().ticks, 3);
}
