//! Thread mode: after every tick it goes over what the ticks left and what came on the lines.

use embedded_storage::nor_flash::NorFlash;
use heapless::spsc::Consumer;
use leadscrew_app::link::Link;
use leadscrew_app::modbus::Modbus;
use leadscrew_app::report::Report;

use crate::line::Bytes;

/// Bytes that are taken from a line at a time.
const PIECE: usize = 64;
/// What the last words may take before a restart, µs.
const LAST_WORDS_US: u32 = 100_000;

/// The axis as a unit on its line.
pub struct ModbusLine<L> {
    /// The line.
    pub line: L,
    /// The unit.
    pub unit: &'static mut Modbus,
}

/// What thread mode works with; a board calls all of it once a tick, in the order of the methods.
pub struct Server<L, M, F: NorFlash + 'static> {
    /// What carries the link.
    pub line: L,
    /// The line of the outer control.
    pub modbus: ModbusLine<M>,
    /// The link.
    pub link: &'static mut Link<F>,
    /// What the ticks leave.
    pub reports: Consumer<'static, Report>,
    restart_by_us: Option<u32>,
}

impl<L: Bytes, M: Bytes, F: NorFlash> Server<L, M, F> {
    /// All that thread mode needs, before the first tick.
    pub fn new(
        line: L,
        modbus: ModbusLine<M>,
        link: &'static mut Link<F>,
        reports: Consumer<'static, Report>,
    ) -> Self {
        Self {
            line,
            modbus,
            link,
            reports,
            restart_by_us: None,
        }
    }

    /// Passes on what the ticks left.
    pub fn report(&mut self) {
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
    pub fn receive(&mut self) {
        let mut bytes = [0; PIECE];
        loop {
            let count = self.line.read(&mut bytes);
            if count == 0 {
                break;
            }
            let Self { line, link, .. } = self;
            let came = bytes.get(..count).unwrap_or_default();
            link.receive(came, &mut |bytes| line.send(bytes));
        }
    }

    /// Answers what came on the Modbus line. `now_us`: a clock that wraps.
    pub fn serve_modbus(&mut self, now_us: u32) {
        let Self { modbus, link, .. } = self;
        let ModbusLine { line, unit } = modbus;
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
            let came = bytes.get(..count).unwrap_or_default();
            unit.receive(came, now_us, *link, send);
        }
    }

    /// Whether the firmware is to be started anew now: it was asked for, and the answer is out, or has had its time. `now_us`:
    /// a clock that wraps.
    pub fn is_restart_due(&mut self, now_us: u32) -> bool {
        self.link.wants_restart() && is_over(&mut self.restart_by_us, now_us, self.line.is_sent())
    }
}

/// Whether the last words are out, or their time is.
fn is_over(restart_by_us: &mut Option<u32>, now_us: u32, is_sent: bool) -> bool {
    let by = *restart_by_us.get_or_insert(now_us.wrapping_add(LAST_WORDS_US));
    is_sent || now_us.wrapping_sub(by).cast_signed() >= 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_restart_waits_for_the_last_words_but_not_for_ever() {
        let start = u32::MAX - 10;
        let after = |passed: u32| start.wrapping_add(passed);
        assert!(is_over(&mut None, start, true));
        let mut by = None;
        assert!(!is_over(&mut by, start, false));
        assert!(!is_over(&mut by, after(LAST_WORDS_US - 1), false));
        assert!(is_over(&mut by, after(LAST_WORDS_US), false));
        assert!(is_over(&mut by, after(50), true));
    }
}
