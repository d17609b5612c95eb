//! The converter through its failures.
//!
//! ```text
//!        reset line high      settled, reset word     settled          well
//! Rests ─────────────────► Wakes ─────────────► Settles ─────► Trial ─────► Up
//!   ▲  while the axis is off, some times             │           │           │
//!   └────────── held in reset: 0 V ◄─────────────────┴───────────┴───────────┘
//!                               on: at once          trouble     trouble while off
//! ```
//!
//! A converter that fails is set up anew while the axis is off: in steps of a tick, each no longer than a tick's own three words.
//! After [`TRIES`] in vain it stays in reset until the next start. Whatever it does, a converter that is not up is told to the
//! supervisor as one that does not put out the command, so no axis can be enabled on it.

use leadscrew::units::Command;

use super::trial::Trial;
use super::{Bus, Converter, Put, Trouble, opposite};

/// Times that a converter is set up anew before it is given up.
pub const TRIES: u8 = 5;
/// Ticks of trouble running, with the axis off, after which it is set up anew: the supervisor has seen it by then.
const TROUBLED: u32 = 20;
/// What a converter takes after its reset, s: ten times what the data sheet has for its reference.
const SETTLE_S: f64 = 1e-3;
/// Between two tries, s; and for so long it has to be well to be tried [`TRIES`] times again.
const PAUSE_S: f64 = 1.0;

#[derive(Clone, Debug)]
enum State {
    /// Set up; with ticks running that were well, and that were not.
    Up {
        converter: Converter,
        well: u32,
        troubled: u32,
    },
    /// Held in reset, for so many ticks if there is a try left.
    Rests {
        left: u32,
    },
    /// Out of reset, before the reset word.
    Wakes {
        left: u32,
    },
    /// After the reset word.
    Settles {
        left: u32,
    },
    Tried(Trial),
}

/// The converter through its failures.
#[derive(Clone, Debug)]
pub struct Upkeep {
    state: State,
    trouble: Option<Trouble>,
    is_reference_internal: bool,
    tries: u8,
    settle_ticks: u32,
    pause_ticks: u32,
}

impl Upkeep {
    /// Sets the converter up at 0 V, before the first tick. `settle` waits for 1 ms.
    pub fn start(
        bus: &mut impl Bus,
        is_reference_internal: bool,
        mut settle: impl FnMut(),
    ) -> Self {
        let mut upkeep = Self {
            state: State::Rests { left: 0 },
            trouble: None,
            is_reference_internal,
            tries: TRIES,
            settle_ticks: 1,
            pause_ticks: 1,
        };
        bus.hold_reset(false);
        settle();
        let started = Converter::reset(bus).and_then(|()| {
            settle();
            Converter::start(bus, is_reference_internal)
        });
        match started {
            Ok(converter) => upkeep.is_up(converter),
            Err(trouble) => upkeep.rest(bus, trouble),
        }
        upkeep
    }

    /// Takes the rate of the ticks to come, a second.
    pub fn pace(&mut self, tick_hz: f64) {
        // The first of them may come at once.
        self.settle_ticks = (SETTLE_S * tick_hz) as u32 + 2;
        self.pause_ticks = (PAUSE_S * tick_hz) as u32;
        if let State::Rests { left } = &mut self.state {
            *left = self.pause_ticks;
        }
    }

    /// What is wrong with it, if it is not up or not well.
    #[must_use]
    pub const fn trouble(&self) -> Option<Trouble> {
        self.trouble
    }

    /// Puts a command out, or has the converter recover; in every tick. `is_off`: drive off and brake closed. `is_alert`: its
    /// alert line is active. At most three words.
    pub fn put(
        &mut self,
        bus: &mut impl Bus,
        command: Command,
        is_off: bool,
        is_alert: bool,
    ) -> Put {
        if let State::Up {
            converter,
            well,
            troubled,
        } = &mut self.state
        {
            let put = converter.put(bus, command, is_alert);
            self.trouble = put.trouble;
            if put.trouble.is_none() {
                *troubled = 0;
                *well = well.saturating_add(1);
                if *well >= self.pause_ticks {
                    self.tries = TRIES;
                }
            } else {
                *well = 0;
                *troubled = troubled.saturating_add(1);
            }
            let is_over = *troubled >= TROUBLED && is_off;
            if let Some(trouble) = put.trouble.filter(|_| is_over) {
                self.rest(bus, trouble);
            }
            return put;
        }
        // As it is in this tick: the command is put out from the next one on.
        let trouble = self.trouble;
        if is_off {
            self.recover(bus);
        } else if !matches!(self.state, State::Rests { .. }) {
            self.rest(bus, Trouble::Silent);
        }
        Put {
            readback: opposite(command),
            trouble,
        }
    }

    /// A tick of the way up.
    fn recover(&mut self, bus: &mut impl Bus) {
        match &mut self.state {
            State::Rests { left } | State::Wakes { left } | State::Settles { left }
                if *left > 0 =>
            {
                *left -= 1;
            }
            State::Rests { .. } => {
                if let Some(tries) = self.tries.checked_sub(1) {
                    self.tries = tries;
                    bus.hold_reset(false);
                    self.state = State::Wakes {
                        left: self.settle_ticks,
                    };
                }
            }
            State::Wakes { .. } => match Converter::reset(bus) {
                Ok(()) => {
                    self.state = State::Settles {
                        left: self.settle_ticks,
                    };
                }
                Err(trouble) => self.rest(bus, trouble),
            },
            State::Settles { .. } => {
                self.state = State::Tried(Trial::new(self.is_reference_internal));
            }
            State::Tried(trial) => match trial.step(bus) {
                Ok(None) => {}
                Ok(Some(converter)) => self.is_up(converter),
                Err(trouble) => self.rest(bus, trouble),
            },
            State::Up { .. } => {}
        }
    }

    const fn is_up(&mut self, converter: Converter) {
        self.trouble = None;
        self.state = State::Up {
            converter,
            well: 0,
            troubled: 0,
        };
    }

    fn rest(&mut self, bus: &mut impl Bus, trouble: Trouble) {
        bus.hold_reset(true);
        self.trouble = Some(trouble);
        self.state = State::Rests {
            left: self.pause_ticks,
        };
    }
}
