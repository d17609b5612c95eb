//! The axis firmware on its link, with a simulated machine in place of encoder and drive; it runs until it is told to end.
//! [`board_mps2_an386::simulated`] has the interrupts.
//!
//! ```text
//! UART 0, or lockstep ─► link ─► requests ─► tick          thread mode, once a tick:
//!                     ◄─      ◄─ reports  ◄─               reports, bytes, barrier
//! UART 1: Modbus
//! flash image: the store
//! ```
//!
//! Arguments: see [`words`].
#![no_std]
#![no_main]

mod axis;
mod boot;
mod serve;
mod words;

use board_mps2_an386::flash::Flash;
use board_mps2_an386::interrupts::interrupt;
use board_mps2_an386::simulated::{self, Job};
use board_mps2_an386::uart::{UART0, UART1};
use board_mps2_an386::{exit_failure, time_driver};
use embassy_executor::Spawner;
use leadscrew_app::link::Link;
use leadscrew_hal_mock::scenario::Fate;
use static_cell::StaticCell;

use serve::{Common, Server};
use words::Words;

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
    time_driver::start();
    let words = Words::of_command_line();
    let Ok(factory) = axis::factory(&words) else {
        defmt::error!("the axis does not fit its machine: choose another tick-hz or estimator");
        exit_failure()
    };
    let (control, link, tick_hz) = boot::axis(&words, factory);
    let Ok(plant) = axis::plant(&words, tick_hz) else {
        defmt::error!("the machine does not run at {=f64} Hz", tick_hz);
        exit_failure()
    };
    let job = Job {
        plant,
        control,
        fate: Fate::new(&[], tick_hz),
    };
    let tick_hz = tick_hz as u32;
    let period = simulated::period(tick_hz);
    let reports = simulated::wire(job, period, words.options.ticks);
    let (carrier, modbus) = boot::lines(&words, factory);
    simulated::unmask(&[&UART0, &UART1]);
    static LINK: StaticCell<Link<Flash>> = StaticCell::new();
    let common = Common::new(carrier, modbus, LINK.init(link), reports);
    let server = Server::new(common, words.options.ticks);
    defmt::info!("linked: {=u32} Hz", tick_hz);
    spawner.spawn(serve::serve(server, period).expect("spawned once"));
}
