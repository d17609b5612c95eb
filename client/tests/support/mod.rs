//! An axis on its machine in this process, and lines to it.

#![allow(dead_code, reason = "every test file uses a part of it")]

#[path = "../../../tests/protocol/rig.rs"]
pub mod rig;
#[path = "../../../tests/support/seeded.rs"]
pub mod seeded;

use std::cell::RefCell;
use std::io;
use std::rc::Rc;
use std::time::Duration;

use leadscrew::axis::{Axis as CoreAxis, Outputs};
use leadscrew::hal::Reference;
use leadscrew::protocol::service::{Seen, Service};
use leadscrew::supervisor::State;
use leadscrew::telemetry::Record;
use leadscrew_client::{Axis, Line, Options};
use leadscrew_hal_mock::board::{Board, BoardParams};
use leadscrew_hal_mock::machine::MachineParams;
use rig::{IDENTITY, Way, settings};

/// An axis, its machine and its end of the link, at 1 kHz.
pub struct Bench {
    pub board: Board,
    pub way: Way,
    pub service: Service,
    pub counts_per_mm: f64,
    /// Setpoints, d, and whether they moved the axis, of all ticks.
    pub trace: Vec<(f64, bool)>,
    /// Inputs of the axis's board on top of the machine's.
    pub emergency_stop: bool,
}

impl Bench {
    pub fn new() -> Self {
        Self::with(&BoardParams::default())
    }

    fn with(board: &BoardParams) -> Self {
        let mut settings = settings();
        let config = settings.validate().unwrap();
        let machine = MachineParams::z_16k20f3();
        Self {
            board: Board::new(board, &machine, 1000.0, 1).unwrap(),
            way: Way {
                axis: CoreAxis::new(config),
                enable: false,
                motions: 0,
                enables: 0,
                is_blocked: false,
                followed: None,
            },
            service: Service::new(IDENTITY, &settings, &config),
            counts_per_mm: settings.axis.motion.counts_per_mm,
            trace: Vec::new(),
            emergency_stop: false,
        }
    }

    pub fn outputs(&self) -> &Outputs {
        self.way.axis.outputs()
    }

    pub fn state(&self) -> State {
        self.outputs().state
    }

    /// mm to which the setpoints of all ticks came, smallest and largest.
    pub fn extent_mm(&self) -> (f64, f64) {
        let mm = |setpoint: f64| setpoint / self.counts_per_mm;
        let in_control = self.trace.iter().filter(|(_, in_control)| *in_control);
        let all = in_control.map(|(setpoint, _)| mm(*setpoint));
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
            (low.min(at), high.max(at))
        })
    }

    /// One tick, with bytes that came from the tool; gives those to it.
    pub fn step(&mut self, bytes: &[u8], to_tool: &mut Vec<u8>) {
        self.board.step(self.way.axis.outputs());
        let mut inputs = self.board.inputs(self.way.enable, Reference::default());
        inputs.lines.emergency_stop |= self.emergency_stop;
        let outputs = *self.way.axis.step(&inputs);
        let in_control = matches!(
            outputs.state,
            State::Ready | State::Moving | State::Stopping
        );
        self.trace
            .push((outputs.setpoint.position.to_num(), in_control));
        let seen = Seen::of(&self.way.axis);
        if let Some(frame) = self.service.record(&Record::new(&outputs)) {
            to_tool.extend_from_slice(frame);
        }
        self.service.poll(&seen, &mut self.way);
        self.service
            .receive(bytes, &seen, &mut self.way, &mut |frame| {
                to_tool.extend_from_slice(frame);
            });
    }
}

/// A line to a bench in lockstep: so many ticks an exchange, and no other time.
#[derive(Clone)]
pub struct BenchLine {
    pub bench: Rc<RefCell<Bench>>,
    pub ticks: u32,
    pub is_cut: Rc<std::cell::Cell<bool>>,
    pub is_lockstep: bool,
    time: Duration,
}

impl BenchLine {
    pub fn new() -> Self {
        Self {
            bench: Rc::new(RefCell::new(Bench::new())),
            ticks: 2,
            is_cut: Rc::default(),
            is_lockstep: false,
            time: Duration::ZERO,
        }
    }

    /// The same with a home switch at that place.
    pub fn with_home_switch(home_mm: f64) -> Self {
        let mut board = BoardParams::default();
        board.switches.home_mm = home_mm;
        let line = Self::new();
        *line.bench.borrow_mut() = Bench::with(&board);
        line
    }

    /// An axis over this line, which stays in hand here.
    pub fn open(&self, options: Options) -> Axis {
        Axis::open(self.clone(), options).unwrap()
    }

    /// Ticks that pass while no tool listens.
    pub fn run(&self, ticks: u32) {
        let mut bench = self.bench.borrow_mut();
        (0..ticks).for_each(|_| bench.step(&[], &mut Vec::new()));
    }
}

impl Line for BenchLine {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        let mut bench = self.bench.borrow_mut();
        let before = received.len();
        let mut out = if self.is_cut.get() { &[] } else { out };
        for _ in 0..self.ticks {
            bench.step(std::mem::take(&mut out), received);
        }
        if self.is_cut.get() {
            received.truncate(before);
        }
        self.time += Duration::from_millis(self.ticks.into());
        Ok(self.time)
    }

    fn name(&self) -> String {
        "bench".to_owned()
    }

    fn is_lockstep(&self) -> bool {
        self.is_lockstep
    }
}

pub fn seeded_options(seed: u32) -> Options {
    Options {
        seed: Some(seed),
        ..Options::default()
    }
}
