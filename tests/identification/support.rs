//! An axis that is to be identified, on a simulated machine.

use leadscrew::axis::{Axis, Inputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Encoder;
use leadscrew::identification::{Identification, Identified, IdentifyParams, Refusal};
use leadscrew::params::{AxisParams, MotionParams};
use leadscrew::units::{AxisScale, Command};
use leadscrew_hal_mock::machine::{Machine, MachineParams};

/// Entries of the work memory of a calibration.
pub const MEMORY: usize = 10_000;

/// A machine and what is done with it.
pub struct Bench {
    pub machine: MachineParams,
    pub params: IdentifyParams,
    pub tick_hz: f64,
    pub seed: u64,
    /// −1.0 for a command whose wires are exchanged.
    pub polarity: i32,
}

/// What came of it.
pub struct Outcome {
    pub result: Result<Identified, Refusal>,
    /// Furthest from the start, d.
    pub furthest_d: f64,
    /// Largest command, of full command.
    pub largest_command: f64,
    /// Command at the end.
    pub last_command: Command,
}

impl Bench {
    pub fn of(machine: MachineParams) -> Self {
        Self {
            machine,
            params: IdentifyParams::default(),
            tick_hz: 1000.0,
            seed: 1,
            polarity: 1,
        }
    }

    pub fn bare() -> Self {
        Self::of(MachineParams::z_16k20f3().bare())
    }

    pub fn full() -> Self {
        Self::of(MachineParams::z_16k20f3())
    }

    pub fn axis(&self) -> Axis<'static> {
        let estimator = EstimatorConfig::by_name("exponential").unwrap().unwrap();
        let params = AxisParams {
            tick_hz: self.tick_hz,
            timer_hz: self.machine.encoder.encoder.timer_hz,
            motion: MotionParams {
                counts_per_mm: self.machine.mount.counts_per_mm,
                ..MotionParams::default()
            },
            ..AxisParams::new(estimator)
        };
        Axis::new(params.validate().unwrap())
    }

    pub fn scale(&self) -> AxisScale {
        AxisScale::new(self.machine.mount.counts_per_mm, self.tick_hz).unwrap()
    }

    pub fn run(&self) -> Outcome {
        let scale = self.scale();
        let mut machine = Machine::new(&self.machine, self.tick_hz, self.seed).unwrap();
        let mut axis = self.axis();
        let mut memory = vec![0x5555_5555; MEMORY];
        let full = scale.velocity_from_feed(9600.0).unwrap();
        let mut identification =
            Identification::new(&self.params, scale, full, &mut memory).unwrap();
        let start = machine.truth().shaft.position;
        let (mut furthest_d, mut largest_command) = (0.0_f64, 0.0_f64);
        let most = (200.0 * self.tick_hz) as u32;
        for tick in 0..most {
            let (command, enabled) = (axis.outputs().command, axis.outputs().enabled);
            let command = Command::from_bits(command.to_bits() * self.polarity);
            machine.step(command, enabled);
            axis.step(&Inputs::of(machine.capture(), true));
            let outputs = axis.outputs();
            furthest_d = furthest_d.max((machine.truth().shaft.position - start).abs());
            largest_command = largest_command.max(outputs.command.to_num::<f64>().abs());
            // One tick for the enable.
            if tick < 20 {
                continue;
            }
            let done = identification.tend(&mut axis);
            let outcome = |result| Outcome {
                result,
                furthest_d,
                largest_command,
                last_command: axis.outputs().command,
            };
            match done {
                Ok(None) => {}
                Ok(Some(identified)) => return outcome(Ok(identified)),
                Err(refusal) => return outcome(Err(refusal)),
            }
        }
        panic!("identification does not end within {most} ticks");
    }

    /// The result of a run that must have one.
    #[track_caller]
    pub fn identified(&self) -> Identified {
        match self.run().result {
            Ok(identified) => identified,
            Err(refusal) => panic!("refused: {refusal}"),
        }
    }
}
