//! The standard move, a short one, on the simulated machine with each estimator: inputs and outputs of every tick.

use leadscrew::estimator::EstimatorConfig;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{MoveAndBack, ScenarioError, Simulation};

use super::{ESTIMATORS, Words};

/// Distance, mm: short, as the emulated part is slow.
const MOVE_MM: f64 = 8.0;
const DWELL_S: f64 = 0.02;
const TICK_HZ: f64 = 1000.0;
/// Ticks between two words: how near a difference is told.
const EVERY: u32 = 16;

/// The group.
pub fn run(words: &mut Words<'_>) {
    for name in ESTIMATORS {
        if travel(name, words).is_err() {
            words.push(u32::MAX);
        }
    }
}

#[inline(never)]
fn travel(name: &str, words: &mut Words<'_>) -> Result<(), ScenarioError> {
    let scenario = MoveAndBack {
        move_mm: MOVE_MM,
        dwell_s: DWELL_S,
        ..MoveAndBack::standard(TICK_HZ)
    };
    let estimator = EstimatorConfig::by_name(name)?.expect("it is in the list");
    let machine = MachineParams::z_16k20f3();
    let mut simulation = Simulation::prepare(&scenario, &machine, estimator, 1)?;
    let mut tick = 0;
    while let Some(outputs) = simulation.step()? {
        tick += 1;
        if tick % EVERY == 0 {
            words.push(simulation.digest() as u32);
            words.push(outputs.command.to_bits().cast_unsigned());
        }
    }
    words.push(simulation.ticks());
    words.push((simulation.digest() >> 32) as u32);
    words.push(simulation.digest() as u32);
    Ok(())
}
