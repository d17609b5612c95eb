//! The machine at the part's pins: what changes when, and what the part puts out.

use super::{AxisMachine, STEP, wired, within_step};
use crate::emulator::{Pin, Surroundings};

impl AxisMachine {
    /// Levels that the machine knows from step to step only.
    pub(super) fn tell_levels(&mut self, clock: u64, changes: &mut Vec<(u64, Pin, bool)>) {
        let lines = self.world.board.lines();
        let home_at = self
            .world
            .inputs(self.outputs.relays.0)
            .capture
            .home
            .map_or(clock, |latch| within_step(clock - clock % STEP, latch.time));
        let levels = [
            (wired::DRIVE_READY, !lines.drive_ready, clock),
            (wired::DRIVE_FAULT, lines.drive_fault, clock),
            (wired::ENCODER_LOST, lines.encoder_lost, clock),
            (wired::MASTER_LOST, lines.master_lost, clock),
            (wired::EMERGENCY_STOP, lines.emergency_stop, clock),
            (wired::LIMIT_LOW, lines.limit_low, clock),
            (wired::LIMIT_HIGH, lines.limit_high, clock),
            (wired::HOME, lines.home, home_at),
            (wired::CONVERTER_ALERT, true, clock),
        ];
        for (pin, level, at) in levels {
            let known = &mut self.levels[pin.index()];
            if *known != Some(level) {
                *known = Some(level);
                changes.push((at, pin, level));
            }
        }
    }
}

impl Surroundings for AxisMachine {
    fn next_change(&self) -> u64 {
        self.pending
            .front()
            .map_or(self.next_step, |&(clock, ..)| clock.min(self.next_step))
    }

    fn advance(&mut self, clock: u64, changes: &mut Vec<(Pin, bool)>) {
        while let Some(&(at, pin, level)) = self.pending.front()
            && at <= clock
        {
            self.pending.pop_front();
            changes.push((pin, level));
        }
        while self.next_step <= clock {
            self.step();
        }
    }

    fn output(&mut self, clock: u64, pin: Pin, level: bool) {
        self.outputs.change(clock, pin, level);
    }

    fn transfer(&mut self, _clock: u64, byte: u8) -> u8 {
        self.outputs.converter.transfer(byte)
    }

    fn analog(&self) -> u16 {
        self.analog
    }
}
