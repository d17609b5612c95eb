//! The axis firmware with a simulated machine in place of encoder and drive; [`board_mps2_an386::simulated`] has the interrupts.
//!
//! The run is the standard move there and back, or a scenario that is built in (`scenario=NAME`). At its end the digest
//! of all inputs and outputs is logged, which is that of the host's simulation of the same run. A late or overlong tick
//! fails the run.
//!
//! Arguments: `scenario=NAME`, and see [`leadscrew_app::options`].
#![no_std]
#![no_main]

mod course;
mod thread;

use board_mps2_an386::interrupts::interrupt;
use board_mps2_an386::{arguments, exit_failure, simulated, time_driver};
use embassy_executor::Spawner;
use leadscrew_app::options::Options;
use leadscrew_app::telemetry::Plan;
use leadscrew_hal_mock::scenario::{Scenario, built_in};

use course::{Course, Panel};

#[interrupt]
fn TIMER0() {
    simulated::machine_interrupt();
}

#[interrupt]
fn TIMER1() {
    simulated::tick_interrupt();
}

#[interrupt]
fn SPARE30() {
    simulated::report_interrupt();
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let (options, scenario) = options();
    let made = match scenario {
        Some(scenario) => Course::scenario(scenario),
        None => Course::standard_move(&options),
    };
    let Ok(course) = made else {
        defmt::error!("the scenario does not fit the machine");
        exit_failure()
    };
    let tick_hz = course.tick_hz as u32;
    let period = simulated::period(tick_hz);
    let ticks = options.ticks.unwrap_or(course.ticks);
    let reports = simulated::wire(course.job, period, Some(ticks));
    // A plant with its troubles takes a while to be put in its place.
    time_driver::start();
    simulated::unmask(&[]);
    let plan = Plan {
        ticks,
        report_every: tick_hz,
    };
    let desk = match course.panel {
        Panel::Script(script) => {
            spawner.spawn(thread::operate(course.ends.requests, script).expect("spawned once"));
            None
        }
        Panel::Desk(desk) => Some((desk, course.ends.requests)),
    };
    spawner.spawn(thread::report(reports, course.ends.outcomes, plan, desk).expect("spawned once"));
    defmt::info!("axis: {=u32} ticks at {=u32} Hz", ticks, tick_hz);
    simulated::start(period);
}

/// Words of the command line, and the scenario that they name.
fn options() -> (Options, Option<&'static Scenario<'static>>) {
    let mut options = Options::default();
    let mut scenario = None;
    let result = arguments(|word| {
        if let Some(name) = word.strip_prefix("scenario=") {
            scenario = built_in(name);
            if scenario.is_none() {
                defmt::error!("argument {=str}: there is no such scenario", word);
                exit_failure();
            }
            return Ok(());
        }
        options
            .apply(word)
            .inspect_err(|error| defmt::error!("argument {=str}: {}", word, error))
    });
    if result.is_err() {
        exit_failure();
    }
    (options, scenario)
}
