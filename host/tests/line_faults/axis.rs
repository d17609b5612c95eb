//! Moves over a line with faults.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use leadscrew_client::noisy::{Done, Faults, Noisy};
use leadscrew_client::{Axis, Error, Options};
use leadscrew_hal_mock::scenario::Base;
use leadscrew_host::simulated_axis::{FlashImage, SimulatedAxis};

use crate::watch::Watch;

pub const MOVES: u32 = 20;
const TARGETS_MM: [f64; 4] = [10.0, -20.0, 30.0, 0.0];
const FEED_MM_PER_MIN: f64 = 4000.0;
/// Times that it may begin anew before the test gives up.
const MOST_TRIES: u32 = 400;

/// How a run went.
#[derive(Debug, Default)]
pub struct Run {
    /// Moves that arrived.
    pub made: u32,
    /// Times that the tool was told of a lapse of its lease, or of an axis that was off when it should not be.
    pub lapsed: u32,
    /// Sessions that ended, each followed by a new one.
    pub lost: u32,
    pub done: Done,
    pub seen: Watch,
}

/// A flash with a tuned axis in it, and its counts per mm.
fn image() -> (FlashImage, f64) {
    let flash = FlashImage::blank();
    let line = SimulatedAxis::new(Base::Full, 1000.0, 1, flash.clone()).unwrap();
    let mut tool = Axis::open(line, options()).unwrap();
    tool.edit_parameters(|edit| {
        for (name, value) in crate::tuned::tuned() {
            edit.set_parameter(&name, value)?;
        }
        Ok(())
    })
    .unwrap();
    tool.save_parameters().unwrap();
    let counts = tool.parameter("motion.counts_per_mm").unwrap();
    (flash, counts.number().unwrap())
}

fn options() -> Options {
    Options {
        seed: Some(1),
        ..Options::default()
    }
}

/// Twenty moves to and fro; each order that fails is given anew.
pub fn run(faults: Faults, seed: u64) -> Run {
    let (flash, counts_per_mm) = image();
    let mut axis = SimulatedAxis::new(Base::Full, 1000.0, 1, flash).unwrap();
    let seen = Rc::new(RefCell::new(Watch::new(counts_per_mm)));
    let watch = Rc::clone(&seen);
    axis.watch(move |record, bytes| watch.borrow_mut().tick(record, bytes));
    let noisy = Noisy::new(axis, faults, seed);
    let done: Rc<Cell<Done>> = noisy.done();
    let mut tool = Axis::open(noisy, options()).unwrap();
    let mut run = Run::default();
    while run.made < MOVES {
        assert!(run.lapsed + run.lost < MOST_TRIES, "{run:?}");
        let target_mm = TARGETS_MM[run.made as usize % TARGETS_MM.len()];
        seen.borrow_mut().target_mm = target_mm;
        let moved = tool
            .enable()
            .and_then(|_| tool.move_and_wait(target_mm, FEED_MM_PER_MIN));
        match moved {
            Ok(status) => {
                assert!((status.setpoint_mm - target_mm).abs() < 1e-3, "{status:?}");
                run.made += 1;
            }
            Err(Error::LeaseLapsed | Error::DisabledMeanwhile { .. }) => run.lapsed += 1,
            Err(error) if error.is_lost() => {
                run.lost += 1;
                assert!((0..20).any(|_| tool.reconnect().is_ok()), "{run:?}");
            }
            Err(error) => panic!("{error}: {run:?}"),
        }
    }
    run.done = done.get();
    run.seen = *seen.borrow();
    run
}
