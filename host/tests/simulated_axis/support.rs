//! An axis whose machine the test can reach while the tool has it.

use std::cell::{RefCell, RefMut};
use std::io;
use std::rc::Rc;
use std::time::Duration;

use leadscrew_client::{Axis, Line, Options};
use leadscrew_hal_mock::scenario::{Base, Trouble};
use leadscrew_host::simulated_axis::{FlashImage, SimulatedAxis};

use crate::session::tuned;

/// A simulated axis in two hands: the tool's and the test's.
#[derive(Clone)]
pub struct Shared(Rc<RefCell<SimulatedAxis>>);

impl Shared {
    pub fn new(tick_hz: f64) -> Self {
        let axis = SimulatedAxis::new(Base::Full, tick_hz, 1, FlashImage::blank()).unwrap();
        Self(Rc::new(RefCell::new(axis)))
    }

    /// The axis between two exchanges.
    pub fn axis(&self) -> RefMut<'_, SimulatedAxis> {
        self.0.borrow_mut()
    }

    /// Lets something go wrong from now on.
    pub fn break_it(&self, trouble: &Trouble) {
        self.axis().world_mut().begin(trouble, 1_000_000).unwrap();
    }

    /// A tool on it, its loop tuned, enabled.
    pub fn ready(&self) -> Axis {
        let mut tool = Axis::open(self.clone(), Options::default()).unwrap();
        let tick_hz = tool.scale().unwrap().tick_hz;
        tool.edit_parameters(|edit| {
            for (name, value) in tuned() {
                let is_rate = name == "tick_hz";
                edit.set_parameter(&name, if is_rate { tick_hz } else { value })?;
            }
            Ok(())
        })
        .unwrap();
        tool.enable().unwrap();
        tool
    }
}

impl Line for Shared {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        self.axis().exchange(out, received)
    }

    fn name(&self) -> String {
        "sim".to_owned()
    }

    fn is_lockstep(&self) -> bool {
        true
    }
}
