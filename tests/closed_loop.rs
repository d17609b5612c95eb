//! The axis on the simulated machine.

use leadscrew::axis::{Axis, Outputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::{MoveAndBack, Script, Simulation};

fn simulation(machine: &MachineParams, scenario: &MoveAndBack, estimator: &str) -> Simulation {
    let estimator = EstimatorConfig::by_name(estimator).unwrap().unwrap();
    let params = scenario.axis_params(machine, estimator).unwrap();
    let config = params.validate().unwrap();
    let script = Script::new(scenario, params.motion.counts_per_mm, &config).unwrap();
    Simulation::new(
        Machine::new(machine, scenario.tick_hz, 1).unwrap(),
        Axis::new(config),
        script,
    )
}

#[test]
fn smoke() {
    for (name, machine) in [
        ("bare", MachineParams::z_16k20f3().bare()),
        ("full", MachineParams::z_16k20f3()),
    ] {
        for hz in [1000.0, 2500.0] {
            for est in EstimatorConfig::NAMES {
                let mut sim = simulation(&machine, &MoveAndBack::standard(hz), est);
                let mut peak = 0.0_f64;
                let mut rms = 0.0;
                let mut last = Outputs::default();
                while let Some(out) = sim.step().unwrap() {
                    let e: f64 = out.following_error.to_num();
                    peak = peak.max(e.abs());
                    rms += e * e;
                    last = out;
                }
                println!(
                    "{name} {hz} {est}: ticks {} peak {peak:.2} rms {:.2} end {:.2} count {} digest {:016x} {:?}",
                    sim.ticks(),
                    (rms / f64::from(sim.ticks())).sqrt(),
                    last.following_error,
                    last.count,
                    sim.digest(),
                    sim.axis.capture_health()
                );
            }
        }
    }
}
