//! The part on rsemu: its description, own models where rsemu's do not do, and the [`Emulator`] of it.
//!
//! Own are the USARTs (baud rate, idle line), the SPI and the ADC (which talk to the surroundings), the pins (changes at
//! their clocks), the reset of the whole part, and a shell around the core: it sleeps at once through a whole round, stands
//! still while the flash erases or programs, as the part does and rsemu's does not, and lets no interrupt into an IT block,
//! after which rsemu's would do the rest of the block whatever its condition.

mod adc;
mod calls;
mod core;
mod description;
mod gate;
mod peripheral;
mod pins;
mod registers;
mod spi;
mod timer;
mod usart;
mod whole_reset;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use rsemu::core::clock::GlobalTime;
use rsemu::core::device::{Device, ResetKind};
use rsemu::core::space::MemAttrs;
use rsemu::core::value::Width;
use rsemu::machine::{BuildOptions, Machine, catalog};

use self::adc::Adc;
use self::calls::Calls;
use self::core::{Core, CoreState};
use self::peripheral::Peripheral;
use self::pins::{Pins, SharedSurroundings};
use self::registers::Timed;
use self::spi::Spi;
use self::usart::Usart;
use self::whole_reset::WholeReset;
use crate::emulator::{Emulator, EmulatorError, Serial, Surroundings, lock};

/// Bytes of the flash.
const FLASH_SIZE: usize = 1 << 20;
const FLASH: u64 = 0x0800_0000;
/// Longest round, ns: nothing that happens within one goes by unseen, as devices tell when they have to be looked at.
const ROUND_NS: u64 = 20_000;

/// The part.
pub struct Part {
    machine: Machine,
    cpu: Arc<Mutex<Option<Arc<Core>>>>,
    pins: Pins,
    link: Arc<Timed<Usart>>,
    modbus: Arc<Timed<Usart>>,
    state: Arc<CoreState>,
    watchdog: Arc<AtomicU64>,
}

fn failed(error: &rsemu::Error) -> EmulatorError {
    EmulatorError(error.to_string())
}

impl Part {
    /// An erased flash.
    #[must_use]
    pub fn blank_flash() -> Vec<u8> {
        vec![0xff; FLASH_SIZE]
    }

    /// Switches the part on with that in its flash.
    ///
    /// # Errors
    /// The description and rsemu do not agree.
    pub fn new(
        flash: Vec<u8>,
        surroundings: impl Surroundings + 'static,
    ) -> Result<Self, EmulatorError> {
        Self::made(flash, surroundings, false)
    }

    /// The same with 4 MB of RAM at 0x2000_0000, as the board in QEMU has: for programs that run on both.
    ///
    /// # Errors
    /// As of [`Self::new`].
    pub fn with_more_ram(
        flash: Vec<u8>,
        surroundings: impl Surroundings + 'static,
    ) -> Result<Self, EmulatorError> {
        Self::made(flash, surroundings, true)
    }

    fn made(
        flash: Vec<u8>,
        surroundings: impl Surroundings + 'static,
        more_ram: bool,
    ) -> Result<Self, EmulatorError> {
        let around: SharedSurroundings = Arc::new(Mutex::new(Box::new(surroundings)));
        let pins = Pins::new(around.clone());
        let (link, modbus) = (Timed::new(Usart::default()), Timed::new(Usart::default()));
        let (state, watchdog) = (Arc::default(), Arc::default());
        let cpu = Arc::default();
        let mut options = catalog::build_options().map_err(|error| failed(&error))?;
        // The table knows rsemu's own classes only.
        options.classes = Default::default();
        options.realize.media.insert("flash", flash);
        options.realize.scheduler.quantum = GlobalTime::from_nanos(ROUND_NS);
        let mut part = Self {
            machine: Self::build(
                &around,
                &pins,
                [&link, &modbus],
                &state,
                &watchdog,
                &cpu,
                (options, &description::description(more_ram)),
            )?,
            cpu,
            pins,
            link,
            modbus,
            state,
            watchdog,
        };
        part.fill_ram()?;
        Ok(part)
    }

    fn build(
        around: &SharedSurroundings,
        pins: &Pins,
        usarts: [&Arc<Timed<Usart>>; 2],
        state: &Arc<CoreState>,
        watchdog: &Arc<AtomicU64>,
        cpu: &Arc<Mutex<Option<Arc<Core>>>>,
        (mut options, text): (BuildOptions, &str),
    ) -> Result<Machine, EmulatorError> {
        let mut registry = catalog::registry().map_err(|error| failed(&error))?;
        let classes = [
            &core::CLASS,
            &pins::CLASS,
            &timer::CLASS,
            &whole_reset::CLASS,
            &peripheral::LINK,
            &peripheral::MODBUS,
            &peripheral::SPI,
            &peripheral::ADC,
        ];
        for class in classes {
            registry.add(class).map_err(|error| failed(&error))?;
        }
        let bindings = &mut options.bindings;
        let [link, modbus] = usarts.map(Arc::clone);
        let (spi, adc) = (
            Timed::new(Spi::new(around.clone())),
            Timed::new(Adc::new(around.clone())),
        );
        bindings.replace(peripheral::LINK.name, move |_| {
            Ok(Arc::new(Peripheral::new(link.clone(), &peripheral::LINK)))
        });
        bindings.replace(peripheral::MODBUS.name, move |_| {
            Ok(Arc::new(Peripheral::new(
                modbus.clone(),
                &peripheral::MODBUS,
            )))
        });
        bindings.replace(peripheral::SPI.name, move |_| {
            Ok(Arc::new(Peripheral::new(spi.clone(), &peripheral::SPI)))
        });
        bindings.replace(peripheral::ADC.name, move |_| {
            Ok(Arc::new(Peripheral::new(adc.clone(), &peripheral::ADC)))
        });
        let pins = pins.clone();
        bindings.replace(pins::CLASS.name, move |_| Ok(Arc::new(pins.clone())));
        let (state, cpu) = (Arc::clone(state), Arc::clone(cpu));
        bindings.replace(core::CLASS.name, move |props| {
            let core = Arc::new(Core::new(props, Arc::clone(&state))?);
            *lock(&cpu) = Some(Arc::clone(&core));
            Ok(core)
        });
        bindings.replace(timer::CLASS.name, |props| {
            Ok(Arc::new(timer::Timer::new(props)?))
        });
        let watchdog = Arc::clone(watchdog);
        bindings.replace(whole_reset::CLASS.name, move |_| {
            Ok(Arc::new(WholeReset::new(Arc::clone(&watchdog))))
        });
        rsemu::machine::build("stm32f407", text, &registry, &options)
            .map_err(|error| failed(&error))
    }

    /// RAM is not zero at power-on.
    fn fill_ram(&mut self) -> Result<(), EmulatorError> {
        let mut word = 0x1234_5678_u32;
        for (base, size) in [(0x2000_0000_u64, 128 * 1024), (0x1000_0000, 64 * 1024)] {
            let bytes: Vec<u8> = (0..size)
                .map(|_| {
                    word = word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    (word >> 24) as u8
                })
                .collect();
            let space = self.machine.space("mem");
            let written = space.map(|space| space.write_bytes(base, &bytes, MemAttrs::DEFAULT));
            if !matches!(written, Some(Ok(()))) {
                return Err(EmulatorError(format!("no RAM at {base:#x}")));
            }
        }
        Ok(())
    }

    fn usart(&self, port: Serial) -> &Timed<Usart> {
        match port {
            Serial::Link => &self.link,
            Serial::Modbus => &self.modbus,
        }
    }

    fn with_core<R>(&self, look: impl FnOnce(&Core) -> R) -> Option<R> {
        lock(&self.cpu).as_ref().map(|core| look(core))
    }

    /// Where the core is and how it fares, for messages.
    #[must_use]
    pub fn describe(&self) -> String {
        let text = self.with_core(|core| {
            let cpu = core.cpu();
            format!(
                "pc {:#010x}, exception {:?}, asleep {}, locked up {}, bus faults {:?}",
                cpu.pc(),
                cpu.current_exception(),
                cpu.is_asleep(),
                cpu.is_locked_up(),
                cpu.bus_faults()
            )
        });
        text.unwrap_or_default()
    }
}

impl Emulator for Part {
    fn run_until(&mut self, clock: u64) -> Result<(), EmulatorError> {
        let nanoseconds = u128::from(clock) * 1_000_000_000 / u128::from(crate::CLOCK_HZ);
        let deadline = GlobalTime::from_nanos(nanoseconds as u64);
        self.machine
            .run_until(deadline)
            .map_err(|error| failed(&error))
    }

    fn now(&self) -> u64 {
        self.pins.current_tick()
    }

    fn reset(&mut self) {
        self.machine.reset(ResetKind::Warm);
    }

    fn resets(&self) -> u32 {
        let asked = self.state.asked.load(Ordering::Relaxed);
        (asked + self.watchdog.load(Ordering::Relaxed)) as u32
    }

    fn cycles(&self) -> u64 {
        self.state.awake.load(Ordering::Relaxed)
    }

    fn flash(&self) -> Vec<u8> {
        let mut content = vec![0; FLASH_SIZE];
        if let Some(space) = self.machine.space("mem") {
            // What cannot be read stays zero, which no store and no program survives unseen.
            let _ = space.read_bytes(FLASH, &mut content, MemAttrs::DEBUG);
        }
        content
    }

    fn peek(&self, address: u32) -> Option<u32> {
        let space = self.machine.space("mem")?;
        let word = space
            .read(address.into(), Width::U32, MemAttrs::DEBUG)
            .ok()?;
        Some(word as u32)
    }

    fn poke(&mut self, address: u32, word: u32) {
        if let Some(space) = self.machine.space("mem") {
            let _ = space.write(address.into(), Width::U32, word.into(), MemAttrs::DEFAULT);
        }
    }

    fn fetch(&mut self, address: u32) -> Option<u32> {
        let space = self.machine.space("mem")?;
        let word = space.read(address.into(), Width::U32, MemAttrs::DEFAULT);
        word.ok().map(|word| word as u32)
    }

    fn jump(&mut self, address: u32, arguments: &[u32]) {
        let _ = self.with_core(|core| core.jump(address, arguments));
    }

    fn exception(&self) -> u16 {
        self.with_core(|core| core.cpu().current_exception().0)
            .unwrap_or_default()
    }

    fn count_calls(&mut self, function: Option<u32>) {
        *lock(&self.state.calls) = function.map(Calls::of);
    }

    fn calls(&mut self) -> Vec<u32> {
        let mut calls = lock(&self.state.calls);
        calls.as_mut().map(Calls::take).unwrap_or_default()
    }

    fn send(&mut self, port: Serial, bytes: &[u8]) {
        self.usart(port).with(|usart, now| usart.bring(bytes, now));
    }

    fn receive(&mut self, port: Serial) -> Vec<u8> {
        self.usart(port).with(|usart, _| usart.take())
    }
}
