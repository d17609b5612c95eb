//! Counts the instructions of every stage over the standard move and under adversarial inputs, and
//! logs one line a stage: `bench <stage> <median> <worst> <samples>`.
//!
//! Runs under `-icount shift=N` with the argument `shift=N`; `cargo xtask bench` does.
#![no_std]
#![no_main]

mod adversary;
mod calibration;
mod compensation;
mod edges;
mod link;
mod one_stamp;
mod samples;
mod scope;
mod simulator;
mod sources;
mod staged;
mod standard_move;
mod whole;

use board_mps2_an386::instructions::Counter;
use board_mps2_an386::{arguments, exit_failure, exit_success, time_driver};
use cortex_m_rt::entry;
use leadscrew_hal_mock::scenario::ScenarioError;

const DEFAULT_SHIFT: u32 = 10;

#[entry]
fn main() -> ! {
    // For the log's timestamps only.
    time_driver::start();
    let shift = shift_argument();
    let core = cortex_m::Peripherals::take().expect("main runs once");
    match Counter::calibrate(core.SYST, shift) {
        Ok(mut counter) => match run(&mut counter) {
            Ok(()) => exit_success(),
            Err(_) => defmt::error!("the standard move does not fit the machine"),
        },
        Err(error) => defmt::error!("cannot count instructions: {}", error),
    }
    exit_failure()
}

fn run(counter: &mut Counter) -> Result<(), ScenarioError> {
    standard_move::run(counter)?;
    whole::run(counter)?;
    one_stamp::run(counter)?;
    sources::run(counter)?;
    adversary::run(counter)?;
    edges::run(counter)?;
    calibration::run(counter);
    compensation::run(counter)?;
    scope::run(counter)?;
    link::run(counter)?;
    simulator::run(counter)
}

fn shift_argument() -> u32 {
    let mut shift = Some(DEFAULT_SHIFT);
    let parsed = arguments(|word| {
        shift = word.strip_prefix("shift=").and_then(|n| n.parse().ok());
        shift.map(|_| ()).ok_or(())
    });
    match (parsed, shift) {
        (Ok(()), Some(shift)) => shift,
        _ => {
            defmt::error!("the only argument is shift=N, the N of -icount shift=N");
            exit_failure()
        }
    }
}
