//! What all own devices share: registers of 32 bits that are brought to the present before they are touched.

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

use rsemu::core::error::BusError;
use rsemu::core::sched::{AccessKind, LazyHandle};
use rsemu::core::space::{AccessConstraints, MemAttrs, MemOps, MemResult};
use rsemu::core::value::{Endian, Width};
use rsemu::core::wire::{Level, WireSource};

use crate::emulator::lock;

/// No event.
pub const NEVER: u64 = u64::MAX;

/// The registers of a device, and what becomes of them with time.
pub trait Model: Send + fmt::Debug {
    /// Reads a register; `looks_only` for a debugger, who changes nothing.
    fn read(&mut self, offset: u64, now: u64, looks_only: bool) -> u32;

    /// Writes one.
    fn write(&mut self, offset: u64, value: u32, now: u64);

    /// Lets time go on.
    fn advance(&mut self, now: u64);

    /// The clock of the next event, or [`NEVER`].
    fn next_event(&self) -> u64;

    /// The level of the interrupt, and of the request to the DMA.
    fn lines(&self) -> [bool; 2];

    /// All registers as after a reset.
    fn reset(&mut self, now: u64);
}

/// A model in its place among the devices.
#[derive(Debug)]
pub struct Timed<M> {
    model: Mutex<M>,
    tick: AtomicU64,
    next: AtomicU64,
    lazy: OnceLock<LazyHandle>,
    lines: [Mutex<Option<WireSource>>; 2],
}

impl<M: Model> Timed<M> {
    /// A model that begins at clock zero.
    pub fn new(model: M) -> Arc<Self> {
        Arc::new(Self {
            model: Mutex::new(model),
            tick: AtomicU64::new(0),
            next: AtomicU64::new(NEVER),
            lazy: OnceLock::new(),
            lines: Default::default(),
        })
    }

    /// Lets `change` change the model, then tells of what came of it.
    pub fn with<R>(&self, change: impl FnOnce(&mut M, u64) -> R) -> R {
        let result = {
            let mut model = lock(&self.model);
            let result = change(&mut model, self.tick());
            self.next.store(model.next_event(), Ordering::Relaxed);
            result
        };
        self.drive();
        result
    }

    /// Drives the lines as the model has them.
    pub fn drive(&self) {
        let levels = lock(&self.model).lines();
        for (line, level) in self.lines.iter().zip(levels) {
            if let Some(source) = &*lock(line) {
                source.set(Level::from(level));
            }
        }
    }

    /// Connects the interrupt, line 0, or the request, line 1.
    pub fn connect(&self, line: usize, source: WireSource) {
        *lock(&self.lines[line]) = Some(source);
    }

    /// Gives it the handle that brings it to the present.
    pub fn attach(&self, handle: LazyHandle) {
        let _ = self.lazy.set(handle);
    }

    /// Brings it to the present.
    pub fn sync(&self) {
        if let Some(handle) = self.lazy.get() {
            let _ = handle.sync(AccessKind::Guest);
        }
    }

    /// Where it stands.
    pub fn tick(&self) -> u64 {
        self.tick.load(Ordering::Relaxed)
    }

    /// Its next event, for the scheduler.
    pub fn next(&self) -> Option<u64> {
        let next = self.next.load(Ordering::Relaxed);
        (next != NEVER).then_some(next.max(self.tick() + 1))
    }

    /// Lets time go on.
    pub fn advance(&self, tick: u64) {
        if tick > self.tick() {
            self.tick.store(tick, Ordering::Relaxed);
            self.with(M::advance);
        }
    }
}

impl<M: Model> MemOps for Timed<M> {
    fn read(&self, offset: u64, dst: &mut [u8], attrs: MemAttrs) -> MemResult {
        if !attrs.debug {
            self.sync();
        }
        let word = self.with(|model, now| model.read(offset & !3, now, attrs.debug));
        let bytes = word.to_le_bytes();
        let from = (offset & 3) as usize;
        let Some(part) = bytes.get(from..from + dst.len()) else {
            return Err(BusError::BadAccess);
        };
        dst.copy_from_slice(part);
        Ok(())
    }

    fn write(&self, offset: u64, src: &[u8], attrs: MemAttrs) -> MemResult {
        if attrs.debug || src.len() > 4 {
            return Err(BusError::BadAccess);
        }
        self.sync();
        let word = src
            .iter()
            .rev()
            .fold(0, |word, &byte| word << 8 | u32::from(byte));
        self.with(|model, now| model.write(offset & !3, word, now));
        Ok(())
    }

    fn constraints(&self) -> AccessConstraints {
        AccessConstraints::word(Width::U32, Endian::Little).with_widths(Width::U8, Width::U32)
    }
}
