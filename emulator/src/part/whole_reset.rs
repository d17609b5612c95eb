//! A watchdog's reset: of the whole part, not of the core alone.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

use rsemu::core::device::{Device, DeviceClass, MachineReset, RealizeCtx, ResetKind, SinkPin};
use rsemu::core::error::Result;
use rsemu::core::wire::{Level, WireId, WireSink};
use rsemu::machine::Instance;

use crate::emulator::lock;

/// Turns a pulse into a reset of the part.
#[derive(Debug, Default)]
pub struct WholeReset {
    pulses: Arc<AtomicU64>,
    reset: Arc<OnceLock<Arc<MachineReset>>>,
    sinks: Mutex<Vec<Arc<Trigger>>>,
}

#[derive(Debug)]
struct Trigger {
    pulses: Arc<AtomicU64>,
    reset: Arc<OnceLock<Arc<MachineReset>>>,
}

impl WireSink for Trigger {
    fn set_level(&self, _source: WireId, _line: u32, level: Level) {
        if level.is_high()
            && let Some(reset) = self.reset.get()
        {
            self.pulses.fetch_add(1, Ordering::Relaxed);
            reset.request();
        }
    }
}

impl WholeReset {
    /// One that counts its resets.
    pub fn new(pulses: Arc<AtomicU64>) -> Self {
        Self {
            pulses,
            ..Self::default()
        }
    }
}

impl Device for WholeReset {
    fn class(&self) -> &'static DeviceClass {
        &CLASS
    }

    fn realize(&self, ctx: &mut RealizeCtx<'_>) -> Result<()> {
        let _ = self.reset.set(ctx.machine_reset()?);
        Ok(())
    }

    fn reset(&self, _kind: ResetKind) {}

    fn sink(&self, port: &str, _sources: &[WireId]) -> Option<SinkPin> {
        let sink = Arc::new(Trigger {
            pulses: Arc::clone(&self.pulses),
            reset: Arc::clone(&self.reset),
        });
        lock(&self.sinks).push(Arc::clone(&sink));
        (port == "in").then_some(SinkPin { sink, line: 0 })
    }
}

impl Instance for WholeReset {}

/// The class.
pub static CLASS: DeviceClass = DeviceClass {
    name: "axis.reset",
    version: 1,
    summary: "the reset of the whole part",
    properties: &[],
    construct: |_| Ok(Box::new(WholeReset::default())),
};
