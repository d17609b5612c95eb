//! The flashed image, its machine, and a tool on its link.

use std::cell::RefCell;
use std::io;
use std::rc::Rc;
use std::sync::MutexGuard;
use std::time::Duration;

use leadscrew_client::{Axis, Line, Options};
use leadscrew_emulator::{AxisMachine, EmulatedAxis, Emulator as _, MachineHandle, firmware};
use leadscrew_hal_mock::scenario::Base;

/// From power-on to the first tick, and some.
pub const BOOT_MS: u64 = 200;

/// A board that both a tool and the test hold on to.
#[derive(Clone)]
pub struct Board(Rc<RefCell<EmulatedAxis>>);

impl Board {
    /// A blank board that was just switched on.
    pub fn blank() -> Self {
        let machine = AxisMachine::workshop(Base::Full, 1).expect("the workshop's machine");
        let elf = firmware().unwrap_or_else(|error| panic!("{error}"));
        let axis = EmulatedAxis::new(elf, machine).expect("the image runs");
        Self(Rc::new(RefCell::new(axis)))
    }

    /// The same board, switched off for a time and on again: the flash is what it was, the machine stands at its beginning.
    pub fn power_cycled(&self) -> Self {
        let flash = self.0.borrow_mut().part().flash();
        let machine = AxisMachine::workshop(Base::Full, 1).expect("the workshop's machine");
        let elf = self.0.borrow().elf().clone();
        let axis = EmulatedAxis::with_flash(elf, flash, machine).expect("the image runs");
        Self(Rc::new(RefCell::new(axis)))
    }

    /// Lets time pass without a tool.
    pub fn run_ms(&self, milliseconds: u64) {
        self.with(|axis| axis.run_ms(milliseconds).expect("it runs"));
    }

    /// Has a look, or a hand in it.
    pub fn with<R>(&self, act: impl FnOnce(&mut EmulatedAxis) -> R) -> R {
        act(&mut self.0.borrow_mut())
    }

    /// Does something with the machine.
    pub fn machine<R>(&self, act: impl FnOnce(&mut MutexGuard<'_, AxisMachine>) -> R) -> R {
        let machine = MachineHandle::clone(self.0.borrow().machine());
        act(&mut machine.lock().expect("a machine"))
    }

    /// A tool on the link, some time after power-on.
    pub fn tool(&self) -> Axis {
        let options = Options {
            seed: Some(1),
            ..Options::default()
        };
        let opened = Axis::open(self.clone(), options);
        opened
            .unwrap_or_else(|error| panic!("{error}; {}", self.with(|axis| axis.part().describe())))
    }
}

impl Line for Board {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        self.0.borrow_mut().exchange(out, received)
    }

    fn name(&self) -> String {
        self.0.borrow().name()
    }

    fn is_lockstep(&self) -> bool {
        true
    }
}
