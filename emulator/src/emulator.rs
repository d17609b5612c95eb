//! The seam: what an emulator of the part does, and what is around the part.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// A pin of the ports A to C.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pin(u8);

impl Pin {
    /// All of them.
    pub const COUNT: usize = 48;

    /// A pin of port A.
    #[must_use]
    pub const fn a(number: u8) -> Self {
        Self(number & 15)
    }

    /// A pin of port B.
    #[must_use]
    pub const fn b(number: u8) -> Self {
        Self(16 + (number & 15))
    }

    /// A pin of port C.
    #[must_use]
    pub const fn c(number: u8) -> Self {
        Self(32 + (number & 15))
    }

    /// Its place among all: 0 for PA0, 16 for PB0.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The pin at a place.
    #[must_use]
    pub const fn at(index: usize) -> Option<Self> {
        if index < Self::COUNT {
            Some(Self(index as u8))
        } else {
            None
        }
    }
}

impl fmt::Display for Pin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let port = char::from(b'A' + self.0 / 16);
        write!(f, "P{port}{}", self.0 % 16)
    }
}

/// What is around the part. Times are in clocks of [`CLOCK_HZ`](crate::CLOCK_HZ) since power-on and never go back.
pub trait Surroundings: Send {
    /// When a level changes next, or something else happens here: after the last `advance`.
    fn next_change(&self) -> u64;

    /// Lets time go on to `clock`, which is no later than [`Self::next_change`]; tells what changes by then.
    fn advance(&mut self, clock: u64, changes: &mut Vec<(Pin, bool)>);

    /// The part drives a pin to another level.
    fn output(&mut self, clock: u64, pin: Pin, level: bool);

    /// The part has sent a byte over SPI1; gives what came back meanwhile.
    fn transfer(&mut self, clock: u64, byte: u8) -> u8;

    /// What the part's converter reads at its input 10, 12 bits.
    fn analog(&self) -> u16;
}

impl<S: Surroundings> Surroundings for Arc<Mutex<S>> {
    fn next_change(&self) -> u64 {
        lock(self).next_change()
    }

    fn advance(&mut self, clock: u64, changes: &mut Vec<(Pin, bool)>) {
        lock(self).advance(clock, changes);
    }

    fn output(&mut self, clock: u64, pin: Pin, level: bool) {
        lock(self).output(clock, pin, level);
    }

    fn transfer(&mut self, clock: u64, byte: u8) -> u8 {
        lock(self).transfer(clock, byte)
    }

    fn analog(&self) -> u16 {
        lock(self).analog()
    }
}

/// The content of a mutex; a test that failed with it locked has failed anyway.
pub(crate) fn lock<T: ?Sized>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A serial port of the part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Serial {
    /// USART1.
    Link,
    /// USART6.
    Modbus,
}

/// The emulator cannot go on.
#[derive(Debug)]
pub struct EmulatorError(pub String);

impl fmt::Display for EmulatorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for EmulatorError {}

/// An STM32F4 with a program in its flash.
pub trait Emulator {
    /// Runs until at least `clock`, in clocks of [`CLOCK_HZ`](crate::CLOCK_HZ) since power-on.
    ///
    /// # Errors
    /// What cannot be emulated.
    fn run_until(&mut self, clock: u64) -> Result<(), EmulatorError>;

    /// Clocks since power-on.
    fn now(&self) -> u64;

    /// Pulls the reset line: RAM stays, all else begins anew.
    fn reset(&mut self);

    /// Resets so far that the part made itself: by its watchdog, or by its program.
    fn resets(&self) -> u32;

    /// Cycles that the core was awake since power-on.
    fn cycles(&self) -> u64;

    /// The whole flash as it is now, what a cut of the power leaves of it.
    fn flash(&self) -> Vec<u8>;

    /// A word of the address space, without side effects; `None` where there is nothing.
    fn peek(&self, address: u32) -> Option<u32>;

    /// Changes a word of RAM, as a fault of the program would.
    fn poke(&mut self, address: u32, word: u32);

    /// Reads a word as the program does, with what reading does to a register.
    fn fetch(&mut self, address: u32) -> Option<u32>;

    /// Lets the program go on at an address with `arguments` in its first registers, from wherever it is: to call what it
    /// would not call, or to lead it astray.
    fn jump(&mut self, address: u32, arguments: &[u32]);

    /// Number of the exception that is handled, 0 for none.
    fn exception(&self) -> u16;

    /// Counts the instructions of every call of the function, or of the handler of an exception, at that address from now
    /// on, which is slow; `None` ends it. What interrupts a call is not counted.
    fn count_calls(&mut self, function: Option<u32>);

    /// Instructions of each call that returned since this was asked last; they are not cycles.
    fn calls(&mut self) -> Vec<u32>;

    /// Sends bytes to the part, one after the other at its baud rate.
    fn send(&mut self, port: Serial, bytes: &[u8]);

    /// Takes what the part has sent.
    fn receive(&mut self, port: Serial) -> Vec<u8>;
}
