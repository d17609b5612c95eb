//! Thread mode: after every tick it goes over what the ticks left and what came on the lines.

use board_stm32f4::flash::Flash;
use board_stm32f4::tick::READY;
use board_stm32f4::uart::Line;
use board_stm32f4::{safe_state, tick};
use embassy_time::{Duration, Instant};
use heapless::spsc::Consumer;
use leadscrew_app::link::Link;
use leadscrew_app::modbus::{Modbus, Panel as _};
use leadscrew_app::report::Report;

/// Bytes that are taken from a line at a time.
const PIECE: usize = 64;
/// What the last words may take before a restart.
const LAST_WORDS: Duration = Duration::from_millis(100);

/// The axis as a unit on its line.
pub struct ModbusLine {
    pub line: Line,
    pub unit: &'static mut Modbus,
}

/// What thread mode works with.
pub struct Server {
    line: Line,
    modbus: ModbusLine,
    link: &'static mut Link<Flash>,
    reports: Consumer<'static, Report>,
    restart_by: Option<Instant>,
}

/// Serves for ever.
#[embassy_executor::task]
pub async fn serve(server: &'static mut Server) {
    loop {
        READY.wait().await;
        server.report();
        server.receive();
        server.serve_modbus();
        server.restart_if_due();
    }
}

impl Server {
    /// All that thread mode needs, before the first tick.
    pub fn new(
        line: Line,
        modbus: ModbusLine,
        link: &'static mut Link<Flash>,
        reports: Consumer<'static, Report>,
    ) -> Self {
        Self {
            line,
            modbus,
            link,
            reports,
            restart_by: None,
        }
    }

    /// Ticks a second.
    pub fn tick_hz(&self) -> f64 {
        self.link.view().scale.tick_hz()
    }

    /// Passes on what the ticks left.
    fn report(&mut self) {
        let Self {
            line,
            link,
            reports,
            ..
        } = self;
        let send = &mut |bytes: &[u8]| line.send(bytes);
        while let Some(report) = reports.dequeue() {
            link.report(&report, send);
        }
        link.poll(send);
    }

    /// Passes on what came.
    fn receive(&mut self) {
        let mut bytes = [0; PIECE];
        loop {
            let count = self.line.read(&mut bytes);
            if count == 0 {
                break;
            }
            let Self { line, link, .. } = self;
            link.receive(&bytes[..count], &mut |bytes| line.send(bytes));
        }
    }

    /// Answers what came on the Modbus line.
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
                return unit.poll(now_us, *link, send);
            }
            unit.receive(&bytes[..count], now_us, *link, send);
        }
    }

    fn restart_if_due(&mut self) {
        if !self.link.wants_restart() {
            return;
        }
        let now = Instant::now();
        let by = *self.restart_by.get_or_insert(now + LAST_WORDS);
        if self.line.is_sent() || now >= by {
            tick::stop();
            safe_state::restart();
        }
    }
}
