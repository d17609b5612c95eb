//! Closed loops with the observer in them.

use leadscrew::axis::{Axis, Outputs};
use leadscrew::estimator::observer::{self, ObserverParams};
use leadscrew::estimator::{EstimatorConfig, Variances};
use leadscrew::tuning::DriveModel;
use leadscrew::units::AxisScale;
use leadscrew_hal_mock::arc::State;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::{MoveAndBack, Script, Simulation};

/// A run of a machine that may differ from the one that loop and observer are tuned on.
#[derive(Clone, Copy, Debug)]
pub struct Loop {
    pub actual: MachineParams,
    pub nominal: MachineParams,
    pub observer: ObserverParams,
    pub bandwidth_rad_per_s: f64,
    pub scenario: MoveAndBack,
    pub seed: u64,
}

/// What the observer said of a tick and what was true.
#[derive(Clone, Copy, Debug)]
pub struct Tick {
    pub outputs: Outputs,
    pub variances: Variances,
    pub shaft: State,
}

/// What a learned map leaves of the encoder "real".
pub fn mapped(machine: MachineParams) -> MachineParams {
    let mut encoder = EncoderModel::ideal();
    encoder.encoder.noise_d = 0.005;
    encoder.encoder.noise_s = 2e-8;
    MachineParams { encoder, ..machine }
}

/// The reference machine for checking mathematics, its encoder mapped.
pub fn bare() -> MachineParams {
    mapped(MachineParams::z_16k20f3().bare())
}

/// A drive whose gain and natural period differ by these shares.
pub fn detuned(machine: MachineParams, gain: f64, period: f64) -> MachineParams {
    let mut other = machine;
    other.drive.full_command_feed_mm_per_min *= 1.0 + gain;
    other.drive.natural_period_s *= 1.0 + period;
    other
}

/// The observer's parameters for a machine.
pub fn tuned_on(machine: &MachineParams) -> ObserverParams {
    ObserverParams {
        full_command_feed_mm_per_min: machine.drive.full_command_feed_mm_per_min,
        natural_period_s: machine.drive.natural_period_s,
        damping: machine.drive.damping,
        delay_s: machine.drive.delay_s,
        offset: machine.drive.offset,
        ..ObserverParams::default()
    }
}

impl Loop {
    pub fn nominal(machine: MachineParams) -> Self {
        Self {
            actual: machine,
            nominal: machine,
            observer: tuned_on(&machine),
            bandwidth_rad_per_s: 35.0,
            scenario: MoveAndBack::standard(1000.0),
            seed: 1,
        }
    }

    pub fn run(&self) -> Vec<Tick> {
        let scale = AxisScale::new(1000.0, self.scenario.tick_hz).unwrap();
        let observer = observer::Config::new(&self.observer, scale).unwrap();
        self.run_with(EstimatorConfig::Observer(observer)).0
    }

    pub fn run_with(&self, estimator: EstimatorConfig) -> (Vec<Tick>, Axis<'static>) {
        let mut params = self.scenario.axis_params(&self.nominal, estimator).unwrap();
        let drive = DriveModel::second_order(
            self.nominal.drive.natural_period_s,
            self.nominal.drive.damping,
        );
        params.controller = drive.place_poles(self.bandwidth_rad_per_s).unwrap();
        let config = params.validate().unwrap();
        let script = Script::new(&self.scenario, params.motion.counts_per_mm, &config).unwrap();
        let machine = Machine::new(&self.actual, self.scenario.tick_hz, self.seed).unwrap();
        let mut simulation = Simulation::new(machine, Axis::new(config), script);
        let mut ticks = Vec::new();
        while let Some(outputs) = simulation.step().unwrap() {
            let shaft = simulation.machine.truth().shaft;
            ticks.push(Tick {
                outputs,
                variances: simulation.axis.variances(),
                shaft,
            });
        }
        (ticks, simulation.axis)
    }
}

pub fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| {
        (sum + value * value, count + 1.0)
    });
    (sum / f64::max(count, 1.0)).sqrt()
}

impl Tick {
    pub fn acceleration_error(&self) -> f64 {
        self.outputs.estimate.acceleration.to_num::<f64>() - self.shaft.acceleration
    }

    pub fn velocity_error(&self) -> f64 {
        self.outputs.estimate.velocity.to_num::<f64>() - self.shaft.velocity
    }
}
