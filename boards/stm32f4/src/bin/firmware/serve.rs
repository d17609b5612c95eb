//! Thread mode: after every tick it goes over what the ticks left and what came on the lines.

use board_common::serve;
use board_stm32f4::flash::Flash;
use board_stm32f4::tick::READY;
use board_stm32f4::uart::Line;
use board_stm32f4::{safe_state, tick};
use embassy_time::Instant;

/// What thread mode works with.
pub type Server = serve::Server<Line, Line, Flash>;

/// Serves for ever.
#[embassy_executor::task]
pub async fn serve(server: &'static mut Server) {
    loop {
        READY.wait().await;
        server.report();
        server.receive();
        // It may wrap there.
        let now_us = Instant::now().as_micros() as u32;
        server.serve_modbus(now_us);
        if server.is_restart_due(now_us) {
            tick::stop();
            safe_state::restart();
        }
    }
}
