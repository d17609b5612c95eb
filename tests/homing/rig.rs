//! The simulated machine with a home switch and limit switches, and an axis that homes on it.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::{Encoder, Latch, Lines};
use leadscrew::homing::HomingParams;
use leadscrew::params::AxisParams;
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::MoveAndBack;

/// Where the switches are, d of the shaft; the machine starts at 0.5 d.
#[derive(Clone, Copy, Debug)]
pub struct Switches {
    /// The home switch is actuated between these.
    pub home: (f64, f64),
    /// The limit switches are actuated below and above these.
    pub limits: (f64, f64),
}

impl Switches {
    /// A cam of 20 mm from `home` on, and limits half a metre away.
    pub fn at(home: f64) -> Self {
        Self {
            home: (home, home + 20_000.0),
            limits: (-500_000.0, 500_000.0),
        }
    }
}

pub struct Rig {
    pub machine: Machine,
    pub axis: Axis<'static>,
    pub outputs: Outputs,
    pub switches: Switches,
    /// Whether the hardware latches the switch, or only its level is seen.
    pub latches: bool,
    /// Whether the encoder's index is connected.
    pub has_index: bool,
    /// What the lines show besides the switches.
    pub lines: Lines,
    was_home: bool,
}

/// The axis tuned for `machine`, with a soft loop: homing does not need a fast one.
pub fn axis_params(machine: &MachineParams, homing: HomingParams) -> AxisParams {
    let scenario = MoveAndBack::standard(1000.0);
    let estimator = EstimatorConfig::by_name("exponential").unwrap().unwrap();
    AxisParams {
        homing,
        ..scenario.axis_params(machine, estimator).unwrap()
    }
}

impl Rig {
    pub fn new(
        machine: &MachineParams,
        homing: HomingParams,
        switches: Switches,
        seed: u64,
    ) -> Self {
        Self::with_axis(machine, &axis_params(machine, homing), switches, seed)
    }

    pub fn with_axis(
        machine: &MachineParams,
        axis: &AxisParams,
        switches: Switches,
        seed: u64,
    ) -> Self {
        Self {
            machine: Machine::new(machine, 1000.0, seed).unwrap(),
            axis: Axis::new(axis.validate().unwrap()),
            outputs: Outputs::default(),
            switches,
            latches: true,
            has_index: true,
            lines: Lines::default(),
            was_home: true,
        }
    }

    pub fn step(&mut self) -> Outputs {
        self.machine
            .step(self.outputs.command, self.outputs.enabled);
        let shaft = self.machine.truth().shaft.position;
        let (from, to) = self.switches.home;
        let home = (from..to).contains(&shaft);
        let mut capture = self.machine.capture();
        if self.latches && home && !self.was_home {
            // The switch lies between two samples; the count there is that of its place.
            let edge = if shaft - from < to - shaft { from } else { to };
            capture.home = Some(Latch {
                count: (edge.floor() as i32).cast_unsigned(),
                time: capture.sampled_at,
            });
        }
        self.was_home = home;
        if !self.has_index {
            capture.index = None;
        }
        let lines = Lines {
            home,
            limit_low: shaft < self.switches.limits.0,
            limit_high: shaft > self.switches.limits.1,
            ..self.lines
        };
        let inputs = Inputs {
            lines,
            ..Inputs::of(capture, true)
        };
        self.outputs = *self.axis.step(&inputs);
        self.outputs
    }

    pub fn run(&mut self, ticks: usize) {
        for _ in 0..ticks {
            self.step();
        }
    }

    /// Enables, homes and waits for rest; says how many ticks it took.
    pub fn home(&mut self) -> usize {
        self.run(200);
        self.axis.home().unwrap();
        let mut ticks = 0;
        loop {
            let moving = self.step().moving;
            ticks += 1;
            if !moving {
                return ticks;
            }
            assert!(ticks < 1_000_000, "homing does not end");
        }
    }

    /// Raw position of coordinate 0, d.
    pub fn origin(&self) -> Option<f64> {
        self.axis.homing().origin().map(|origin| origin.to_num())
    }
}

pub fn real() -> MachineParams {
    MachineParams::z_16k20f3()
}
