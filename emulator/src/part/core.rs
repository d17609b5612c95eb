//! The core: rsemu's, which sleeps for as long as it sleeps, stands still while the flash is busy, and is not interrupted within
//! an IT block.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

use rsemu::core::device::{Device, DeviceClass, MachineReset, RealizeCtx, ResetKind, SinkPin};
use rsemu::core::error::Result;
use rsemu::core::props::Props;
use rsemu::core::sched::{Budget, Consumed, TickCursor};
use rsemu::core::space::{AddressSpace, MemAttrs};
use rsemu::core::value::Width;
use rsemu::core::wire::{Level, WireId, WireSource};
use rsemu::cpu::arm::v7m::ArmV7m;
use rsemu::machine::{BindCtx, Instance};

use super::calls::{Calls, Place};
use super::gate::{Gate, Gated};
use crate::emulator::lock;

/// Status register of the flash, and its bit "busy".
const FLASH_STATUS: u64 = 0x4002_3c0c;
const BUSY: u64 = 1 << 16;
/// Bits of the status register that tell of an IT block.
const IT_STATE: u32 = 0x0600_fc00;
const CLASS_NAME: &str = "axis.core";

/// What the outside knows of the core.
#[derive(Debug, Default)]
pub struct CoreState {
    /// Cycles awake.
    pub awake: AtomicU64,
    /// The core asked for a reset of the part.
    pub asked: AtomicU64,
    /// Calls to count.
    pub calls: Mutex<Option<Calls>>,
    stands: AtomicBool,
}

/// The core.
#[derive(Debug)]
pub struct Core {
    cpu: ArmV7m,
    state: Arc<CoreState>,
    space: OnceLock<Arc<AddressSpace>>,
    reset: OnceLock<Arc<MachineReset>>,
    told: Mutex<Option<WireSource>>,
    cursor: OnceLock<TickCursor>,
    /// Ticks of the last budget that were overrun while calls are counted.
    owed: AtomicU64,
    gate: Arc<Gate>,
    gated: Mutex<Vec<Arc<Gated>>>,
}

impl Core {
    /// A core as the machine's description has it.
    pub fn new(props: &Props, state: Arc<CoreState>) -> Result<Self> {
        Ok(Self {
            cpu: ArmV7m::from_props(props)?,
            state,
            space: OnceLock::new(),
            reset: OnceLock::new(),
            told: Mutex::new(None),
            cursor: OnceLock::new(),
            owed: AtomicU64::new(0),
            gate: Arc::default(),
            gated: Mutex::default(),
        })
    }

    /// rsemu's own, to look into.
    pub const fn cpu(&self) -> &ArmV7m {
        &self.cpu
    }

    /// Goes on at an address with `arguments` in the first registers, outside of any IT block.
    pub fn jump(&self, address: u32, arguments: &[u32]) {
        for (register, argument) in (0..).zip(arguments) {
            self.cpu.set_reg(register, *argument);
        }
        self.cpu.set_xpsr(self.cpu.xpsr() & !IT_STATE);
        self.cpu.set_pc(address & !1);
    }

    /// The flash erases or programs: no instruction comes from it.
    fn is_starved(&self) -> bool {
        let status = self
            .space
            .get()
            .and_then(|space| space.read(FLASH_STATUS, Width::U32, MemAttrs::DEBUG).ok());
        status.is_some_and(|status| status & BUSY != 0)
    }

    /// Lets interrupts in, at the end of an IT block if the core is in one; the cycles that this took.
    fn open_gate(&self) -> u64 {
        if !self.gate.is_asked() {
            return 0;
        }
        let mut used = 0;
        // A block has four instructions at most; a core that sleeps or locks up in one goes no further.
        for _ in 0..4 {
            if self.cpu.xpsr() & IT_STATE == 0 {
                break;
            }
            used += self.cpu.run_budget(1);
        }
        self.gate.open();
        used
    }

    fn run_awake(&self, ticks: u64) -> u64 {
        let before = self.cpu.cycles();
        let used = match &mut *lock(&self.state.calls) {
            Some(calls) => self.run_counted(ticks, calls),
            None => self.cpu.run_budget(ticks),
        };
        let awake = self.cpu.cycles() - before;
        self.state.awake.fetch_add(awake, Ordering::Relaxed);
        self.heed_reset_request();
        used
    }

    /// As [`ArmV7m::run_budget`], which cannot be had in steps: devices have to know at which of its instructions they are asked.
    fn run_counted(&self, ticks: u64, calls: &mut Calls) -> u64 {
        let mut used = self.owed.swap(0, Ordering::Relaxed);
        while used < ticks {
            if let Some(cursor) = self.cursor.get() {
                cursor.set(cursor.anchor().wrapping_add(used));
            }
            let before = self.place();
            let step = self.cpu.step();
            if step == 0 {
                return used;
            }
            calls.step(before, self.place());
            used += step;
        }
        self.owed.store(used - ticks, Ordering::Relaxed);
        ticks
    }

    fn place(&self) -> Place {
        Place {
            pc: self.cpu.pc(),
            link: self.cpu.reg(14),
            exception: self.cpu.current_exception().0,
            priority: self.cpu.execution_priority(),
        }
    }

    /// The program asked for a reset: of the whole part, not of the core alone.
    fn heed_reset_request(&self) {
        if !self.cpu.reset_requested() {
            return;
        }
        self.cpu.clear_reset_request();
        self.state.asked.fetch_add(1, Ordering::Relaxed);
        if let Some(source) = &*lock(&self.told) {
            source.pulse(Level::High);
        }
        if let Some(reset) = self.reset.get() {
            reset.request();
        }
        self.state.stands.store(true, Ordering::Relaxed);
    }
}

impl Device for Core {
    fn class(&self) -> &'static DeviceClass {
        &CLASS
    }

    fn realize(&self, ctx: &mut RealizeCtx<'_>) -> Result<()> {
        let _ = self.reset.set(ctx.machine_reset()?);
        self.cpu.realize(ctx)
    }

    fn attach_cursor(&self, cursor: TickCursor) {
        let _ = self.cursor.set(cursor.clone());
        Device::attach_cursor(&self.cpu, cursor);
    }

    fn sink(&self, port: &str, sources: &[WireId]) -> Option<SinkPin> {
        let SinkPin { sink, line } = self.cpu.sink(port, sources)?;
        if !port.starts_with("irq") {
            return Some(SinkPin { sink, line });
        }
        let sink = Arc::new(Gated {
            sink,
            gate: Arc::clone(&self.gate),
        });
        lock(&self.gated).push(Arc::clone(&sink));
        Some(SinkPin { sink, line })
    }

    fn connect(&self, _port: &str, source: WireSource) -> Result<()> {
        *lock(&self.told) = Some(source);
        Ok(())
    }

    /// Every reset of the part resets all of the core; rsemu's warm one leaves the interrupt controller as it was. What
    /// drives its lines tells their levels anew.
    fn reset(&self, _kind: ResetKind) {
        self.state.stands.store(false, Ordering::Relaxed);
        self.cpu.reset(ResetKind::Cold);
    }

    fn is_runnable(&self) -> bool {
        true
    }

    fn run(&self, budget: Budget) -> Consumed {
        // A core that waits for its reset does nothing more.
        if self.state.stands.load(Ordering::Relaxed) || self.is_starved() {
            return Consumed::new(budget.ticks);
        }
        let opened = self.open_gate().min(budget.ticks);
        let ticks = budget.ticks - opened;
        if self.cpu.is_asleep() {
            // One cycle, in which it sees whether something woke it: interrupts come between two rounds.
            let used = self.cpu.run_budget(1.min(ticks));
            if self.cpu.is_asleep() {
                return Consumed::new(budget.ticks);
            }
            // The rest at once: a core that consumed less would hold all timers of its crystal back.
            return Consumed::new(opened + used + self.run_awake(ticks - used));
        }
        Consumed::new(opened + self.run_awake(ticks))
    }
}

impl Instance for Core {
    fn bind(&self, ctx: &BindCtx<'_>) -> Result<()> {
        if let Some(space) = ctx.space() {
            let _ = self.space.set(Arc::clone(space));
        }
        Instance::bind(&self.cpu, ctx)
    }
}

/// The class.
pub static CLASS: DeviceClass = DeviceClass {
    name: CLASS_NAME,
    version: 1,
    summary: "the core of the part",
    properties: &[],
    construct: |props| Ok(Box::new(Core::new(props, Arc::default())?)),
};
