//! The timers of the board: registers, and nothing clever.

use crate::registers::Registers;

/// A CMSDK timer: 32 bits, counts down at [`crate::CLOCK_HZ`], reloads, interrupts.
pub struct Timer(Registers);

/// CMSDK timer 0, line `TIMER0`.
pub static TIMER0: Timer = Timer(Registers::new(0x4000_0000));
/// CMSDK timer 1, line `TIMER1`.
pub static TIMER1: Timer = Timer(Registers::new(0x4000_1000));

impl Timer {
    const CTRL: usize = 0x0;
    const VALUE: usize = 0x4;
    const RELOAD: usize = 0x8;
    const INTERRUPT: usize = 0xc;
    const ENABLE_WITH_INTERRUPT: u32 = 0b1001;

    /// Interrupts every `period` clocks, the first time after `first` clocks.
    pub fn start(&self, period: u32, first: u32) {
        self.0.write(Self::CTRL, 0);
        self.0.write(Self::RELOAD, period - 1);
        self.0.write(Self::VALUE, first - 1);
        self.0.write(Self::CTRL, Self::ENABLE_WITH_INTERRUPT);
    }

    /// Stops counting; no interrupt comes any more.
    pub fn stop(&self) {
        self.0.write(Self::CTRL, 0);
        self.acknowledge();
    }

    /// Clears the interrupt.
    pub fn acknowledge(&self) {
        self.0.write(Self::INTERRUPT, 1);
    }

    /// Clocks since the timer last interrupted (from the second period on).
    pub fn since_reload(&self) -> u32 {
        self.0
            .read(Self::RELOAD)
            .wrapping_sub(self.0.read(Self::VALUE))
    }

    /// Whether the timer has interrupted again since [`Timer::acknowledge`].
    pub fn is_due(&self) -> bool {
        self.0.read(Self::INTERRUPT) != 0
    }
}

/// One half of the dual timer.
pub struct HalfTimer(Registers);

/// First half of the dual timer.
pub static DUAL_FIRST: HalfTimer = HalfTimer(Registers::new(0x4000_2000));
/// Second half of the dual timer.
pub static DUAL_SECOND: HalfTimer = HalfTimer(Registers::new(0x4000_2020));

impl HalfTimer {
    const LOAD: usize = 0x00;
    const VALUE: usize = 0x04;
    const CONTROL: usize = 0x08;
    const CLEAR: usize = 0x0c;
    const RAW_STATUS: usize = 0x10;
    const FREE_RUNNING: u32 = 0b1010_0010;
    const ONE_SHOT: u32 = 0b1010_0011;

    /// Counts down from `from` and on from 2³² − 1 after zero, interrupting at every zero.
    pub fn start_free_running(&self, from: u32) {
        self.0.write(Self::CONTROL, 0);
        self.0.write(Self::CONTROL, Self::FREE_RUNNING);
        self.0.write(Self::LOAD, from);
    }

    /// Interrupts once, after `clocks`.
    pub fn start_once(&self, clocks: u32) {
        self.0.write(Self::CONTROL, 0);
        self.0.write(Self::CLEAR, 1);
        self.0.write(Self::LOAD, clocks);
        self.0.write(Self::CONTROL, Self::ONE_SHOT);
    }

    /// The count, downwards.
    pub fn value(&self) -> u32 {
        self.0.read(Self::VALUE)
    }

    /// Whether zero was reached since the last [`HalfTimer::acknowledge`].
    pub fn is_due(&self) -> bool {
        self.0.read(Self::RAW_STATUS) != 0
    }

    /// Clears the interrupt.
    pub fn acknowledge(&self) {
        self.0.write(Self::CLEAR, 1);
    }
}
