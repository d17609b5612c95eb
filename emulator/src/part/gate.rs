//! A gate before the core's interrupt lines: it opens between two instructions of which the second is no part of an IT block.
//!
//! On entry into an exception rsemu leaves the state of an IT block out of the stacked status register, which the architecture
//! has there (DDI 0403, B1.5.6, `PushStack`): after the return the rest of the block was done whatever its condition. So
//! interrupts come between two of the core's turns, and not within such a block.

use std::sync::{Arc, Mutex};

use rsemu::core::wire::{Level, WireId, WireSink};

use crate::emulator::lock;

/// A line that went high.
struct Waiting {
    sink: Arc<dyn WireSink>,
    source: WireId,
    line: u32,
}

/// The lines that wait.
#[derive(Default)]
pub struct Gate(Mutex<Vec<Waiting>>);

impl std::fmt::Debug for Gate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Gate").finish_non_exhaustive()
    }
}

impl Gate {
    /// Whether a line waits.
    pub fn is_asked(&self) -> bool {
        !lock(&self.0).is_empty()
    }

    /// Lets all lines through that wait.
    pub fn open(&self) {
        for Waiting { sink, source, line } in std::mem::take(&mut *lock(&self.0)) {
            sink.set_level(source, line, Level::High);
        }
    }
}

/// A line behind the gate.
pub struct Gated {
    pub sink: Arc<dyn WireSink>,
    pub gate: Arc<Gate>,
}

impl std::fmt::Debug for Gated {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Gated").finish_non_exhaustive()
    }
}

impl WireSink for Gated {
    fn set_level(&self, source: WireId, line: u32, level: Level) {
        let mut waiting = lock(&self.gate.0);
        if level.is_high() {
            waiting.push(Waiting {
                sink: Arc::clone(&self.sink),
                source,
                line,
            });
            return;
        }
        let is_this = |other: &Waiting| {
            other.source == source && other.line == line && Arc::ptr_eq(&other.sink, &self.sink)
        };
        // The program took back what made it high before it was let through.
        waiting.retain(|other| !is_this(other));
        drop(waiting);
        self.sink.set_level(source, line, level);
    }
}
