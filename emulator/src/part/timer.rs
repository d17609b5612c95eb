//! rsemu's timer, with what it leaves out: a capture on the internal trigger also where the slave controller is off.
//!
//! TRC comes before that controller (RM0090, figure of the general-purpose timer), so a free-running timer can latch its time
//! at another one's update. rsemu captures only if the controller is on. The shell puts it into trigger mode for the moment
//! of the edge, which does nothing to a counter that runs, and takes back the flag that this leaves.

use std::sync::{Arc, Mutex};

use rsemu::core::device::{Device, DeviceClass, RealizeCtx, ResetKind, SinkPin};
use rsemu::core::error::Result;
use rsemu::core::props::Props;
use rsemu::core::sched::LazyHandle;
use rsemu::core::space::{MemAttrs, MemOps, RegionKind, RegionRef};
use rsemu::core::wire::{Level, WireId, WireSink, WireSource};
use rsemu::dev::stm32::tim::Tim;
use rsemu::machine::{BindCtx, Instance};

use crate::emulator::lock;

const CONTROL: u64 = 0x00;
const SLAVE: u64 = 0x08;
const STATUS: u64 = 0x10;
const RUNS: u32 = 1;
const SLAVE_MODE: u32 = 7;
const TRIGGER_MODE: u32 = 6;
const TRIGGERED: u32 = 1 << 6;

/// The timer.
#[derive(Debug)]
pub struct Timer {
    inner: Tim,
    sinks: Mutex<Vec<Arc<Trigger>>>,
}

impl Timer {
    /// A timer as the description has it.
    pub fn new(props: &Props) -> Result<Self> {
        Ok(Self {
            inner: Tim::new(props)?,
            sinks: Mutex::default(),
        })
    }

    fn registers(&self) -> Option<Arc<dyn MemOps>> {
        match self.inner.region("")?.kind() {
            RegionKind::Io(registers) => Some(Arc::clone(registers)),
            _ => None,
        }
    }
}

/// An internal trigger.
struct Trigger {
    inner: Arc<dyn WireSink>,
    registers: Arc<dyn MemOps>,
}

impl std::fmt::Debug for Trigger {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Trigger").finish_non_exhaustive()
    }
}

impl Trigger {
    fn read(&self, offset: u64) -> u32 {
        let mut bytes = [0; 4];
        // A timer without its clock reads as zero, which is one that stands.
        let _ = self.registers.read(offset, &mut bytes, MemAttrs::DEBUG);
        u32::from_le_bytes(bytes)
    }

    fn write(&self, offset: u64, value: u32) {
        let _ = self
            .registers
            .write(offset, &value.to_le_bytes(), MemAttrs::DEFAULT);
    }
}

impl WireSink for Trigger {
    fn set_level(&self, source: WireId, line: u32, level: Level) {
        let slave = self.read(SLAVE);
        let is_left_out = slave & SLAVE_MODE == 0 && self.read(CONTROL) & RUNS != 0;
        if !is_left_out || !level.is_high() {
            self.inner.set_level(source, line, level);
            return;
        }
        let was_triggered = self.read(STATUS) & TRIGGERED;
        self.write(SLAVE, slave | TRIGGER_MODE);
        self.inner.set_level(source, line, level);
        self.write(SLAVE, slave);
        if was_triggered == 0 {
            self.write(STATUS, !TRIGGERED);
        }
    }
}

impl Device for Timer {
    fn class(&self) -> &'static DeviceClass {
        &CLASS
    }

    fn realize(&self, ctx: &mut RealizeCtx<'_>) -> Result<()> {
        self.inner.realize(ctx)
    }

    fn reset(&self, kind: ResetKind) {
        Device::reset(&self.inner, kind);
    }

    fn region(&self, name: &str) -> Option<RegionRef> {
        self.inner.region(name)
    }

    fn connect(&self, port: &str, source: WireSource) -> Result<()> {
        self.inner.connect(port, source)
    }

    fn sink(&self, port: &str, sources: &[WireId]) -> Option<SinkPin> {
        let SinkPin { sink, line } = self.inner.sink(port, sources)?;
        if !port.starts_with("itr") {
            return Some(SinkPin { sink, line });
        }
        let trigger = Arc::new(Trigger {
            inner: sink,
            registers: self.registers()?,
        });
        lock(&self.sinks).push(Arc::clone(&trigger));
        Some(SinkPin {
            sink: trigger,
            line,
        })
    }

    fn announce(&self, port: &str) {
        self.inner.announce(port);
    }

    fn is_lazy(&self) -> bool {
        true
    }

    fn current_tick(&self) -> u64 {
        self.inner.current_tick()
    }

    fn advance_to(&self, tick: u64) {
        Device::advance_to(&self.inner, tick);
    }

    fn next_event_tick(&self) -> Option<u64> {
        self.inner.next_event_tick()
    }

    fn attach_lazy(&self, handle: LazyHandle) {
        Device::attach_lazy(&self.inner, handle);
    }
}

impl Instance for Timer {
    fn bind(&self, ctx: &BindCtx<'_>) -> Result<()> {
        Instance::bind(&self.inner, ctx)
    }
}

/// The class.
pub static CLASS: DeviceClass = DeviceClass {
    name: "axis.timer",
    version: 1,
    summary: "a timer of the part",
    properties: &[],
    construct: |props| Ok(Box::new(Timer::new(props)?)),
};
