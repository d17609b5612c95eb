//! An axis to commission, and a person who agrees.

use std::cell::RefCell;
use std::io;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use leadscrew_client::{Axis, Line, Options};
use leadscrew_hal_mock::scenario::{Base, Trouble};
use leadscrew_host::axis::{Guide, ProcedureError};
use leadscrew_host::simulated_axis::{FlashImage, SimulatedAxis};

/// The line to an axis that the test keeps a hand on.
pub struct Shared(Rc<RefCell<SimulatedAxis>>);

impl Line for Shared {
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

/// An axis, and a hand on its machine.
pub struct Bench {
    pub tool: Axis,
    pub machine: Rc<RefCell<SimulatedAxis>>,
    pub interrupted: Arc<AtomicBool>,
}

/// The full machine with what is in its flash.
pub fn bench(flash: &FlashImage) -> Bench {
    let axis = SimulatedAxis::new(Base::Full, 1000.0, 1, flash.clone()).unwrap();
    let machine = Rc::new(RefCell::new(axis));
    let interrupted = Arc::new(AtomicBool::new(false));
    let options = Options {
        interrupted: Some(Arc::clone(&interrupted)),
        seed: Some(1),
        ..Options::default()
    };
    let tool = Axis::open(Shared(Rc::clone(&machine)), options).unwrap();
    Bench {
        tool,
        machine,
        interrupted,
    }
}

impl Bench {
    /// Lets something go wrong for good.
    pub fn trouble(&self, trouble: &Trouble) {
        let mut machine = self.machine.borrow_mut();
        machine.world_mut().begin(trouble, u32::MAX / 2).unwrap();
    }
}

/// Somebody who agrees to all, takes every default, and remembers what was said.
#[derive(Default)]
pub struct Agreeing {
    pub said: Vec<String>,
    pub asked: Vec<String>,
    /// Not to questions with this in them.
    pub refuses: Option<&'static str>,
    /// Presses Ctrl-C when a progress begins so.
    pub interrupts: Option<(&'static str, Arc<AtomicBool>)>,
}

impl Guide for Agreeing {
    fn tell(&mut self, text: &str) {
        println!("{text}");
        self.said.push(text.to_owned());
    }

    fn progress(&mut self, text: &str) {
        if let Some((begin, flag)) = &self.interrupts
            && text.starts_with(begin)
        {
            flag.store(true, Ordering::Relaxed);
        }
    }

    fn agree(&mut self, question: &str, _: bool) -> Result<bool, ProcedureError> {
        println!("? {question}");
        self.asked.push(question.to_owned());
        Ok(!self.refuses.is_some_and(|word| question.contains(word)))
    }

    fn number(&mut self, question: &str, default: f64) -> Result<f64, ProcedureError> {
        println!("? {question} [{default}]");
        self.asked.push(question.to_owned());
        Ok(default)
    }
}
