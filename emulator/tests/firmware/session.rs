//! The flashed image, its machine, and a tool on its link.

use std::cell::RefCell;
use std::io;
use std::rc::Rc;
use std::sync::MutexGuard;
use std::time::Duration;

use leadscrew_client::{Axis, Line, Options};
use leadscrew_emulator::{
    AxisMachine, EmulatedAxis, Emulator as _, MILLISECOND, MachineHandle, Part, Serial, firmware,
};
use leadscrew_hal_mock::scenario::Base;

/// Clocks of an exchange.
const EXCHANGE: u64 = 5 * MILLISECOND;
/// From power-on to the first tick, and some.
pub const BOOT_MS: u64 = 200;

/// A board that both a tool and the test hold on to.
#[derive(Clone)]
pub struct Board {
    axis: Rc<RefCell<EmulatedAxis>>,
    /// When the power is cut, and the flash that is left then.
    cut: Rc<RefCell<Cut>>,
    /// Time at which this line was opened: a line's clock begins then.
    opened: Duration,
}

#[derive(Default)]
struct Cut {
    at: Option<u64>,
    left: Option<Vec<u8>>,
}

impl Board {
    /// A blank board that was just switched on.
    pub fn blank() -> Self {
        Self::with_flash(Part::blank_flash())
    }

    /// A board with what is stored in its flash, just switched on, and the machine at its beginning.
    pub fn with_flash(flash: Vec<u8>) -> Self {
        let machine = AxisMachine::workshop(Base::Full, 1).expect("the workshop's machine");
        Self::at(machine, flash)
    }

    /// A board at a machine.
    pub fn at(machine: MachineHandle, flash: Vec<u8>) -> Self {
        let elf = firmware().unwrap_or_else(|error| panic!("{error}"));
        let axis = EmulatedAxis::with_flash(elf, flash, machine).expect("the image runs");
        Self {
            axis: Rc::new(RefCell::new(axis)),
            cut: Rc::default(),
            opened: Duration::ZERO,
        }
    }

    /// The same board, switched off for a time and on again.
    pub fn power_cycled(&self) -> Self {
        Self::with_flash(self.with(|axis| axis.part().flash()))
    }

    /// Lets a tool do something while the power is cut at a clock; what is left in the flash then.
    pub fn cut_at<R>(&self, clock: u64, act: impl FnOnce() -> R) -> Vec<u8> {
        *self.cut.borrow_mut() = Cut {
            at: Some(clock),
            left: None,
        };
        // It fails, if the cut comes before its end.
        let _ = act();
        let left = self.cut.borrow_mut().left.take();
        left.unwrap_or_else(|| self.with(|axis| axis.part().flash()))
    }

    /// Lets time pass without a tool.
    pub fn run_ms(&self, milliseconds: u64) {
        self.with(|axis| axis.run_ms(milliseconds).expect("it runs"));
    }

    /// Has a look, or a hand in it.
    pub fn with<R>(&self, act: impl FnOnce(&mut EmulatedAxis) -> R) -> R {
        act(&mut self.axis.borrow_mut())
    }

    /// Does something with the machine.
    pub fn machine<R>(&self, act: impl FnOnce(&mut MutexGuard<'_, AxisMachine>) -> R) -> R {
        let machine = MachineHandle::clone(self.axis.borrow().machine());
        act(&mut machine.lock().expect("a machine"))
    }

    /// A tool on the link, some time after power-on.
    pub fn tool(&self) -> Axis {
        let options = Options {
            seed: Some(1),
            ..Options::default()
        };
        let line = Self {
            opened: self.with(|axis| Duration::from_secs_f64(axis.seconds())),
            ..self.clone()
        };
        let opened = Axis::open(line, options);
        opened
            .unwrap_or_else(|error| panic!("{error}; {}", self.with(|axis| axis.part().describe())))
    }
}

impl Line for Board {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        let mut axis = self.axis.borrow_mut();
        let mut cut = self.cut.borrow_mut();
        if let Some(at) = cut.at
            && at < axis.part().now() + EXCHANGE
        {
            if cut.left.is_none() {
                axis.part().send(Serial::Link, out);
                axis.part().run_until(at).map_err(io::Error::other)?;
                cut.left = Some(axis.part().flash());
            }
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        Ok(axis.exchange(out, received)?.saturating_sub(self.opened))
    }

    fn name(&self) -> String {
        self.axis.borrow().name()
    }

    fn is_lockstep(&self) -> bool {
        true
    }
}
