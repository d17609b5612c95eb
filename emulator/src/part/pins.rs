//! The pins: changes of the surroundings come at their clocks, levels that the part drives go out.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

use rsemu::core::device::{Device, DeviceClass, RealizeCtx, ResetKind, SinkPin};
use rsemu::core::error::{Error, Result};
use rsemu::core::sched::{AccessKind, LazyHandle};
use rsemu::core::wire::{Level, WireId, WireSink, WireSource};
use rsemu::machine::Instance;

use crate::emulator::{Pin, Surroundings, lock};

/// The surroundings, which several devices talk to.
pub type SharedSurroundings = Arc<Mutex<Box<dyn Surroundings>>>;

/// What the pins have in common.
pub struct PinState {
    around: SharedSurroundings,
    tick: AtomicU64,
    next: AtomicU64,
    lazy: OnceLock<LazyHandle>,
    /// Where changes go, and the levels that were told last.
    inputs: Mutex<Vec<Option<(WireSource, bool)>>>,
}

/// The pins.
#[derive(Clone)]
pub struct Pins(Arc<PinState>, Arc<Mutex<Vec<Arc<Driven>>>>);

impl std::fmt::Debug for Pins {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Pins").finish_non_exhaustive()
    }
}

/// A pin that the part drives.
struct Driven {
    pins: Arc<PinState>,
    pin: Pin,
}

impl WireSink for Driven {
    fn set_level(&self, _source: WireId, _line: u32, level: Level) {
        if let Some(handle) = self.pins.lazy.get() {
            let _ = handle.sync(AccessKind::Guest);
        }
        let clock = self.pins.tick.load(Ordering::Relaxed);
        lock(&self.pins.around).output(clock, self.pin, level.is_high());
    }
}

/// The pin of a port's name: `pa0`.
fn pin_named(port: &str) -> Option<Pin> {
    let mut letters = port.strip_prefix('p')?.chars();
    let letter = letters.next()? as usize;
    let number: usize = letters.as_str().parse().ok()?;
    Pin::at(letter.checked_sub('a' as usize)? * 16 + number).filter(|_| number < 16)
}

impl Pins {
    /// Pins in their surroundings.
    pub fn new(around: SharedSurroundings) -> Self {
        let inputs = (0..Pin::COUNT).map(|_| None).collect();
        Self(
            Arc::new(PinState {
                around,
                tick: AtomicU64::new(0),
                next: AtomicU64::new(1),
                lazy: OnceLock::new(),
                inputs: Mutex::new(inputs),
            }),
            Arc::default(),
        )
    }

    fn change(&self, changes: &[(Pin, bool)]) {
        for &(pin, level) in changes {
            let source = {
                let mut inputs = lock(&self.0.inputs);
                let Some(Some((source, known))) = inputs.get_mut(pin.index()) else {
                    continue;
                };
                *known = level;
                source.clone()
            };
            source.set(Level::from(level));
        }
    }
}

impl Device for Pins {
    fn class(&self) -> &'static DeviceClass {
        &CLASS
    }

    fn realize(&self, _ctx: &mut RealizeCtx<'_>) -> Result<()> {
        Ok(())
    }

    fn reset(&self, _kind: ResetKind) {}

    fn connect(&self, port: &str, source: WireSource) -> Result<()> {
        let pin = pin_named(port).ok_or_else(|| Error::Config {
            at: port.to_owned(),
            message: "the pins are pa0 to pc15".to_owned(),
        })?;
        lock(&self.0.inputs)[pin.index()] = Some((source, false));
        Ok(())
    }

    fn announce(&self, port: &str) {
        let known = pin_named(port).and_then(|pin| lock(&self.0.inputs)[pin.index()].clone());
        if let Some((source, level)) = known {
            source.set(Level::from(level));
        }
    }

    fn sink(&self, port: &str, _sources: &[WireId]) -> Option<SinkPin> {
        let pin = pin_named(port.strip_suffix("-out")?)?;
        let sink = Arc::new(Driven {
            pins: Arc::clone(&self.0),
            pin,
        });
        lock(&self.1).push(Arc::clone(&sink));
        Some(SinkPin {
            sink,
            line: pin.index() as u32,
        })
    }

    fn is_lazy(&self) -> bool {
        true
    }

    fn current_tick(&self) -> u64 {
        self.0.tick.load(Ordering::Relaxed)
    }

    fn advance_to(&self, tick: u64) {
        let mut changes = Vec::new();
        {
            let mut around = lock(&self.0.around);
            around.advance(tick, &mut changes);
            self.0.tick.store(tick, Ordering::Relaxed);
            self.0
                .next
                .store(around.next_change().max(tick + 1), Ordering::Relaxed);
        }
        self.change(&changes);
    }

    fn next_event_tick(&self) -> Option<u64> {
        Some(self.0.next.load(Ordering::Relaxed))
    }

    fn attach_lazy(&self, handle: LazyHandle) {
        let _ = self.0.lazy.set(handle);
    }
}

impl Instance for Pins {}

/// The class.
pub static CLASS: DeviceClass = DeviceClass {
    name: "axis.pins",
    version: 1,
    summary: "what is at the part's pins",
    properties: &[],
    construct: |_| {
        Err(Error::Config {
            at: "axis.pins".to_owned(),
            message: "pins need surroundings: bind them".to_owned(),
        })
    },
};
