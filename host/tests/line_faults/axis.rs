//! Moves over a line with faults.

use std::cell::RefCell;
use std::rc::Rc;

use leadscrew_client::noisy::{Faults, Noisy};
use leadscrew_client::{Axis, Options};
use leadscrew_hal_mock::scenario::Base;
use leadscrew_host::simulated_axis::{FlashImage, SimulatedAxis};

use crate::shuttle::{Run, shuttle};
use crate::watch::Watch;

pub const MOVES: u32 = 20;
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
    let done = noisy.done();
    let mut tool = Axis::open(noisy, options()).unwrap();
    shuttle(&mut tool, MOVES, &seen, &done, |_| Ok(()))
}
