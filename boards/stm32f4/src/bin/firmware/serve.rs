//! Thread mode: after every tick it goes over what the ticks left and what came on the lines.

use board_common::serve;
use board_stm32f4::flash::Flash;
use board_stm32f4::tick::READY;
use board_stm32f4::uart::Line;
use board_stm32f4::{safe_state, stack, tick};
use embassy_time::{Duration, Instant};

/// Between two looks at how much of the stack was used; each takes half a millisecond.
const STACK_TOLD: Duration = Duration::from_secs(1);

/// What thread mode works with.
pub type Server = serve::Server<Line, Line, Flash>;

/// Serves for ever.
#[embassy_executor::task]
pub async fn serve(server: &'static mut Server) {
    let mut stack_told_at = Instant::now();
    loop {
        READY.wait().await;
        server.report();
        server.receive();
        let now = Instant::now();
        if now >= stack_told_at + STACK_TOLD {
            stack_told_at = now;
            stack::tell();
        }
        // It may wrap there.
        let now_us = now.as_micros() as u32;
        server.serve_modbus(now_us);
        if server.is_restart_due(now_us) {
            tick::stop();
            safe_state::restart();
        }
    }
}
