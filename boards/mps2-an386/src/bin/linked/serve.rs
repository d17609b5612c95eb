//! Thread mode: once a tick the host's turn, what the ticks left and what came on the lines.

use board_common::serve;
use board_mps2_an386::carrier::Carrier;
use board_mps2_an386::flash::Flash;
use board_mps2_an386::lockstep::Turn;
use board_mps2_an386::simulated::{self, COUNTERS, READY};
use board_mps2_an386::uart::Line;
use board_mps2_an386::{exit_failure, exit_success, restart};
use embassy_time::Instant;

/// What every board's thread mode works with.
pub type Common = serve::Server<Carrier, Line, Flash>;

/// What thread mode works with.
pub struct Server {
    common: Common,
    /// Ticks to run; none to run until told.
    ticks: Option<u32>,
}

/// Serves until the program is told to end.
#[embassy_executor::task]
pub async fn serve(mut server: Server, period: u32) {
    // The host's first turn is before the first tick.
    server.keep_step(0);
    simulated::start(period);
    loop {
        READY.wait().await;
        // Counted before the queue is emptied: at the last tick nothing can come behind.
        let ticks = COUNTERS.read().ticks;
        server.common.report();
        server.common.receive();
        server.keep_step(ticks);
        // What came at a barrier is seen by the very next tick.
        server.common.receive();
        let now_us = Instant::now().as_micros() as u32;
        server.common.serve_modbus(now_us);
        if server.ticks.is_some_and(|last| ticks >= last) {
            server.end();
        }
        if server.common.is_restart_due(now_us) {
            restart();
        }
    }
}

impl Server {
    /// All that thread mode needs, before the first tick.
    pub fn new(common: Common, ticks: Option<u32>) -> Self {
        Self { common, ticks }
    }

    /// The host's turn, where it is due.
    fn keep_step(&mut self, ticks: u32) {
        match self.common.line.keep_step(ticks) {
            Ok(Turn::Run) => {}
            Ok(Turn::End) => self.end(),
            Err(error) => {
                defmt::error!("lockstep: {}", error);
                exit_failure()
            }
        }
    }

    /// Logs the counts and ends the program; in failure if a tick was late, overlong or not reported.
    fn end(&self) -> ! {
        let counts = COUNTERS.read();
        simulated::log(&counts);
        if counts.is_clean() {
            exit_success();
        }
        defmt::error!("failed: ticks were late, overlong or not recorded");
        exit_failure()
    }
}
