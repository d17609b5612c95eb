//! The firmware of an axis board without the board: link, Modbus, store and tick, fed by registers that stand for the
//! hardware. For its size, and for the proof that no panic can be reached from the tick. It is built, not run.
#![no_std]
#![no_main]

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::panic::PanicInfo;
use core::ptr::{read_volatile, write_volatile};
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m_rt::{entry, exception};
use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use heapless::spsc::Queue;
use leadscrew::axis::Inputs;
use leadscrew::compensation::Stretch;
use leadscrew::compensation::table::POINTS;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::ObserverParams;
use leadscrew::hal::{Capture, Lines, Reference};
use leadscrew::params::AxisParams;
use leadscrew::protocol::service::Identity;
use leadscrew::settings::Settings;
use leadscrew_app::axis_control::{AxisControl, Inlet};
use leadscrew_app::link::{Boot, Link, Maps, WORDS, WorkMemory};
use leadscrew_app::modbus::{Config, Modbus};
use leadscrew_app::queues::Queues;
use leadscrew_app::report::Report;
use leadscrew_app::store::Interlock;
use leadscrew_app::tick::{Counters, Runtime, TickTimer};
use static_cell::ConstStaticCell;

/// Anything outside, so that nothing is worked out beforehand.
const OUTSIDE: *mut u32 = 0x4002_8000 as *mut u32;

/// The runtime wants a vector table of the device; no interrupt of it is used here.
// SAFETY: the name and the section are those that cortex-m-rt's linker script asks for.
#[unsafe(no_mangle)]
// SAFETY: as above; nothing else is put there.
#[unsafe(link_section = ".vector_table.interrupts")]
pub static __INTERRUPTS: [usize; 1] = [0];

/// Not an option: that none is there is no zero, and would take flash.
struct Shared(UnsafeCell<MaybeUninit<Runtime<AxisControl<Board>>>>);

// SAFETY: filled before `READY`, then only the tick uses it.
unsafe impl Sync for Shared {}
static TICK: Shared = Shared(UnsafeCell::new(MaybeUninit::uninit()));
static READY: AtomicBool = AtomicBool::new(false);
static COUNTERS: Counters = Counters::new();
static INTERLOCK: Interlock = Interlock::new();

struct Board([u32; 64]);
impl Inlet for Board {
    fn inputs(&self, enable: bool) -> Inputs<'_> {
        let n = outside() as usize;
        Inputs {
            capture: Capture {
                count: outside(),
                sampled_at: outside(),
                edges: [
                    self.0.get(n..).unwrap_or_default(),
                    self.0.get(..n).unwrap_or_default(),
                ],
                ..Capture::default()
            },
            enable,
            lines: Lines {
                drive_ready: outside() != 0,
                drive_fault: outside() != 0,
                ..Lines::default()
            },
            reference: Reference {
                steps: outside(),
                master: Some(Capture {
                    count: outside(),
                    ..Capture::default()
                }),
                ..Reference::default()
            },
            ..Inputs::default()
        }
    }
}

struct Timer;
impl TickTimer for Timer {
    fn since_due(&self) -> u32 {
        outside()
    }
    fn is_due_again(&self) -> bool {
        outside() != 0
    }
}

struct Flash;
#[derive(Debug)]
struct FlashError;
impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}
impl ErrorType for Flash {
    type Error = FlashError;
}
impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;
    fn read(&mut self, _offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        bytes.iter_mut().for_each(|byte| *byte = outside() as u8);
        if outside() != 0 {
            Err(FlashError)
        } else {
            Ok(())
        }
    }
    fn capacity(&self) -> usize {
        48 * 1024
    }
}
impl NorFlash for Flash {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = 16 * 1024;
    fn erase(&mut self, from: u32, _to: u32) -> Result<(), FlashError> {
        put(from);
        if outside() != 0 {
            Err(FlashError)
        } else {
            Ok(())
        }
    }
    fn write(&mut self, _offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        bytes.iter().for_each(|byte| put(u32::from(*byte)));
        if outside() != 0 {
            Err(FlashError)
        } else {
            Ok(())
        }
    }
}

#[entry]
fn main() -> ! {
    static QUEUES: ConstStaticCell<Queues> = ConstStaticCell::new(Queues::new());
    static WORK: ConstStaticCell<WorkMemory<WORDS, WORDS>> =
        ConstStaticCell::new(WorkMemory::new());
    static MAPS: ConstStaticCell<Maps> = ConstStaticCell::new(Maps::new());
    static SCREW: ConstStaticCell<[Stretch; POINTS.1]> =
        ConstStaticCell::new([Stretch::EMPTY; POINTS.1]);
    static RECORDS: ConstStaticCell<Queue<Report, 16>> = ConstStaticCell::new(Queue::new());
    let Some(factory) = factory() else {
        stop_here()
    };
    let boot = Boot {
        flash: Flash,
        range: 0..48 * 1024,
        factory,
        identity: Identity {
            firmware: "0",
            build: "release",
            board: "sized",
            capabilities: 0xff,
            work_memory: (4 * WORDS) as u32,
            lead_ticks: 16,
        },
        queues: QUEUES.take(),
        work: WORK.take().lend(),
        maps: MAPS.take().places(),
        screw: SCREW.take(),
        interlock: &INTERLOCK,
        counters: &COUNTERS,
    };
    let Ok((control, mut link, _loaded)) = boot.start() else {
        stop_here()
    };
    let (producer, mut reports) = RECORDS.take().split();
    let runtime = Runtime::new(control, producer, &COUNTERS, 1000);
    // SAFETY: `READY` is not set yet, so the tick keeps off.
    unsafe { (*TICK.0.get()).write(runtime) };
    READY.store(true, Ordering::Release);
    let Ok(config) = Config::serial(1, 115_200) else {
        stop_here()
    };
    let mut modbus = Modbus::new(config, factory);
    let mut bytes = [0; 64];
    loop {
        while let Some(report) = reports.dequeue() {
            link.report(&report, &mut send);
        }
        link.poll(&mut send);
        for byte in &mut bytes {
            *byte = outside() as u8;
        }
        link.receive(&bytes, &mut send);
        serve(&mut modbus, &mut link, &bytes);
        if link.wants_restart() {
            stop_here();
        }
    }
}

fn serve(modbus: &mut Modbus, link: &mut Link<Flash>, bytes: &[u8]) {
    let reply = &mut |reply: &[u8]| {
        send(reply);
    };
    modbus.receive(bytes, outside(), link, reply);
    modbus.poll(outside(), link, reply);
}

fn send(bytes: &[u8]) -> bool {
    bytes.iter().for_each(|byte| put(u32::from(*byte)));
    outside() != 0
}

fn factory() -> Option<Settings> {
    let estimator = EstimatorConfig::by_name("observer").ok()??;
    Some(Settings {
        axis: AxisParams::new(estimator),
        observer: ObserverParams::default(),
    })
}

#[exception]
fn SysTick() {
    if !READY.load(Ordering::Acquire) {
        return;
    }
    // SAFETY: `READY` is set: it is there, and the tick's alone.
    let runtime = unsafe { (*TICK.0.get()).assume_init_mut() };
    let board = Board([0; 64].map(|_: u32| outside()));
    let report = runtime.run(&Timer, Some(&board));
    put(report.record.drive().0.to_bits() as u32);
}

fn put(word: u32) {
    // SAFETY: `OUTSIDE` is a device register of the board; the image is not run.
    unsafe { write_volatile(OUTSIDE, word) }
}

fn outside() -> u32 {
    // SAFETY: `OUTSIDE` is a device register of the board; the image is not run.
    unsafe { read_volatile(OUTSIDE) }
}

fn stop_here() -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}

#[panic_handler]
fn stop(_: &PanicInfo<'_>) -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}
