//! Thread mode: once a tick it goes over what the ticks left and what came on the lines.

use board_mps2_an386::carrier::Carrier;
use board_mps2_an386::flash::Flash;
use board_mps2_an386::lockstep::Turn;
use board_mps2_an386::simulated::{self, COUNTERS, READY};
use board_mps2_an386::uart::Line;
use board_mps2_an386::{exit_failure, exit_success, restart};
use embassy_time::Instant;
use heapless::spsc::Consumer;
use leadscrew_app::link::Link;
use leadscrew_app::modbus::Modbus;
use leadscrew_app::report::Report;

/// Bytes that are taken from a line at a time.
const PIECE: usize = 256;
/// Ticks that the last words may take before a restart.
const LAST_WORDS: u32 = 100;

/// The axis as a unit on UART 1.
pub struct ModbusLine {
    pub line: Line,
    pub unit: Modbus,
}

/// What thread mode works with.
pub struct Server {
    carrier: Carrier,
    modbus: ModbusLine,
    link: Link<Flash>,
    reports: Consumer<'static, Report>,
    /// Ticks to run; none to run until told.
    ticks: Option<u32>,
    /// The tick by which to restart.
    restart_by: Option<u32>,
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
        server.report();
        server.receive();
        server.keep_step(ticks);
        // What came at a barrier is seen by the very next tick.
        server.receive();
        server.serve_modbus();
        server.end_if_due(ticks);
    }
}

impl Server {
    /// All that thread mode needs, before the first tick.
    pub fn new(
        carrier: Carrier,
        modbus: ModbusLine,
        link: Link<Flash>,
        reports: Consumer<'static, Report>,
        ticks: Option<u32>,
    ) -> Self {
        Self {
            carrier,
            modbus,
            link,
            reports,
            ticks,
            restart_by: None,
        }
    }

    /// Passes on what the ticks left.
    fn report(&mut self) {
        let Self {
            carrier,
            link,
            reports,
            ..
        } = self;
        let send = &mut |bytes: &[u8]| carrier.send(bytes);
        while let Some(report) = reports.dequeue() {
            link.report(&report, send);
        }
        link.poll(send);
    }

    /// Passes on what came.
    fn receive(&mut self) {
        let mut bytes = [0; PIECE];
        loop {
            let count = self.carrier.read(&mut bytes);
            if count == 0 {
                break;
            }
            let Self { carrier, link, .. } = self;
            link.receive(&bytes[..count], &mut |bytes| carrier.send(bytes));
        }
    }

    /// Answers what came on UART 1.
    fn serve_modbus(&mut self) {
        let Self { modbus, link, .. } = self;
        let ModbusLine { line, unit } = modbus;
        // The unit wants a clock that wraps.
        let now_us = Instant::now().as_micros() as u32;
        let mut bytes = [0; PIECE];
        loop {
            let count = line.read(&mut bytes);
            // A reply that finds no room is asked for again.
            let send = &mut |reply: &[u8]| {
                line.send(reply);
            };
            if count == 0 {
                return unit.poll(now_us, link, send);
            }
            unit.receive(&bytes[..count], now_us, link, send);
        }
    }

    /// The host's turn, where it is due.
    fn keep_step(&mut self, ticks: u32) {
        match self.carrier.keep_step(ticks) {
            Ok(Turn::Run) => {}
            Ok(Turn::End) => self.end(),
            Err(error) => {
                defmt::error!("lockstep: {}", error);
                exit_failure()
            }
        }
    }

    fn end_if_due(&mut self, ticks: u32) {
        if self.ticks.is_some_and(|last| ticks >= last) {
            self.end();
        }
        if self.link.wants_restart() {
            self.restart_by
                .get_or_insert(ticks.wrapping_add(LAST_WORDS));
        }
        if let Some(by) = self.restart_by
            && (self.carrier.is_sent() || ticks.wrapping_sub(by).cast_signed() >= 0)
        {
            restart();
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
