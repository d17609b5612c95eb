//! The firmware of the axis board.
//!
//! ```text
//! USART1: link ─► requests ─► tick        thread mode, whenever a tick has left something:
//!              ◄─ reports  ◄─             reports, bytes
//! USART6: Modbus
//! flash: the store
//! ```
#![no_std]
#![no_main]

mod boot;
mod factory;
mod serve;

use core::panic::PanicInfo;

use board_stm32f4::{clocks, gpio, priorities, reset_record, safe_state, tick, watchdog};
use embassy_executor::Spawner;
use leadscrew_app::modbus::Panel as _;
use leadscrew_app::safe_state::period::Stuck;
use leadscrew_app::safe_state::record::Record;
use static_cell::StaticCell;

use serve::Server;

const STUCK: &str = "the watchdog did not take its period";

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let reset = reset_record::take();
    clocks::start();
    gpio::configure();
    match start(reset) {
        Ok(server) => match serve::serve(server) {
            Ok(task) => spawner.spawn(task),
            Err(_) => safe_state::stop("the task is spawned already"),
        },
        Err(reason) => safe_state::stop(reason),
    }
}

/// Makes all of it, then lets the interrupts in, the tick last; or says why not.
#[inline(never)]
fn start(reset: Record) -> Result<&'static mut Server, &'static str> {
    static SERVER: StaticCell<Server> = StaticCell::new();
    let mut core = cortex_m::Peripherals::take().ok_or("main runs once")?;
    let (server, period) = boot::boot()?;
    let server = SERVER.init(server);
    server.link.set_reset(reset);
    let tick_hz = server.link.view().scale.tick_hz();
    watchdog::start(tick_hz as u32).map_err(|Stuck| STUCK)?;
    priorities::unmask(&mut core.NVIC);
    tick::start(period);
    watchdog::shorten().map_err(|Stuck| STUCK)?;
    defmt::info!("running at {=f64} Hz", tick_hz);
    Ok(server)
}

#[panic_handler]
fn on_panic(info: &PanicInfo<'_>) -> ! {
    safe_state::on_panic(info)
}
