//! What a scope waits for. It looks in every tick, also in those that are not sampled.

use super::signal::{ReadValue, Signal};
use crate::axis::{Axis, Outputs};
use crate::supervisor::{Fault, FaultSet};

/// What a scope waits for. Levels are whole values in the signal's own bits (64 of a [wide](super::Kind::Wide) one), so
/// that no wrap of a low word comes in between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trigger {
    /// Nothing: the first tick is the trigger.
    Now,
    /// Nothing but being told: [`Scope::trigger`](super::Scope::trigger).
    Force,
    /// A signal beyond a level; the first tick may be it.
    Level {
        /// The signal.
        signal: Signal,
        /// The level; a value that equals it is on neither side.
        level: i64,
        /// Where the value must be.
        side: Side,
    },
    /// A signal that was not beyond a level in the tick before, and is now.
    Edge {
        /// The signal.
        signal: Signal,
        /// The level.
        level: i64,
        /// Which way.
        slope: Slope,
    },
    /// A fault that is latched in this tick: that one, or any. One that came after another was latched is none.
    Fault(Option<Fault>),
    /// A warning that was not there in the tick before.
    Warning,
    /// A commanded motion begins. One that follows another without a tick of rest is part of it.
    Command,
}

/// Side of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Above it.
    Above,
    /// Below it.
    Below,
}

/// Direction of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slope {
    /// To above the level.
    Rising,
    /// To below the level.
    Falling,
    /// One of them.
    Either,
}

/// What the tick before showed, as far as the trigger needs it.
#[derive(Clone, Copy, Debug)]
enum Before {
    /// There was none.
    Nothing,
    Value(i64),
    Warnings(FaultSet),
    Moving(bool),
}

/// Looks for a trigger.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch {
    trigger: Trigger,
    /// Reads the signal that it looks at, if it does.
    read: ReadValue,
    before: Before,
}

impl Watch {
    pub const fn new(trigger: Trigger) -> Self {
        let signal = match trigger {
            Trigger::Level { signal, .. } | Trigger::Edge { signal, .. } => signal,
            _ => Signal::Tick,
        };
        Self {
            trigger,
            read: signal.value_reader(),
            before: Before::Nothing,
        }
    }

    /// True in the tick of the trigger. To be asked in every tick.
    #[inline(never)]
    pub fn sees(&mut self, axis: &Axis<'_>) -> bool {
        let outputs = axis.outputs();
        match self.trigger {
            Trigger::Now => true,
            Trigger::Force => false,
            Trigger::Level { level, side, .. } => {
                let value = (self.read)(axis);
                match side {
                    Side::Above => value > level,
                    Side::Below => value < level,
                }
            }
            Trigger::Edge { level, slope, .. } => self.sees_edge((self.read)(axis), level, slope),
            Trigger::Fault(fault) => is_latched_now(axis, fault),
            Trigger::Warning => self.sees_warning(outputs),
            Trigger::Command => {
                let was_at_rest = matches!(self.before, Before::Moving(false));
                self.before = Before::Moving(outputs.moving);
                was_at_rest && outputs.moving
            }
        }
    }

    const fn sees_edge(&mut self, value: i64, level: i64, slope: Slope) -> bool {
        let before = core::mem::replace(&mut self.before, Before::Value(value));
        let Before::Value(before) = before else {
            return false;
        };
        let rises = before <= level && value > level;
        let falls = before >= level && value < level;
        match slope {
            Slope::Rising => rises,
            Slope::Falling => falls,
            Slope::Either => rises || falls,
        }
    }

    const fn sees_warning(&mut self, outputs: &Outputs) -> bool {
        let warnings = outputs.warnings;
        let before = core::mem::replace(&mut self.before, Before::Warnings(warnings));
        matches!(before, Before::Warnings(before) if warnings.bits() & !before.bits() != 0)
    }
}

fn is_latched_now(axis: &Axis<'_>, fault: Option<Fault>) -> bool {
    let Some(latched) = axis.outputs().fault else {
        return false;
    };
    let first = axis.supervisor().first_fault();
    fault.is_none_or(|fault| fault == latched)
        && first.is_some_and(|first| first.tick == axis.outputs().tick)
}
