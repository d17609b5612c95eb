//! The tick and nothing else, in the profile of the firmware, with a panic that cannot be linked: it links only if no
//! panic can be reached from the tick.
//!
//! Only the tick: the axis comes from outside, so that neither its making nor its configuration is in the image. With
//! `--features planted-panic` the tick indexes by a number from outside, and the image must fail to link.
//! `cargo xtask no-panic` builds both. It is built, not run.
#![no_std]
#![no_main]

use core::panic::PanicInfo;
use core::ptr::{read_volatile, write_volatile};

use cortex_m_rt::{entry, exception};
use leadscrew::axis::Inputs;
use leadscrew::hal::{Capture, Latch, Lines, Reference};
use leadscrew::units::Command;
use leadscrew_app::axis_control::{AxisControl, Inlet};
use leadscrew_app::tick::{Runtime, TickTimer};

/// Anything outside, so that nothing is worked out beforehand.
const OUTSIDE: *mut u32 = 0x4002_8000 as *mut u32;

/// The runtime wants a vector table of the device; no interrupt of it is used here.
// SAFETY: the name and the section are those that cortex-m-rt's linker script asks for.
#[unsafe(no_mangle)]
// SAFETY: as above; nothing else is put there.
#[unsafe(link_section = ".vector_table.interrupts")]
pub static __INTERRUPTS: [usize; 1] = [0];

/// Pins of which nothing is known.
struct Pins([u32; 64]);

impl Pins {
    /// Words from two places that nobody has checked.
    fn words(&self) -> [&[u32]; 2] {
        let place = outside() as usize;
        #[cfg(feature = "planted-panic")]
        put(self.0[place]);
        let (newer, older) = self.0.split_at_checked(place).unwrap_or_default();
        [older, newer]
    }

    fn capture(&self) -> Capture<'_> {
        Capture {
            count: outside(),
            sampled_at: outside(),
            last_edge_at: perhaps(outside),
            edges: self.words(),
            illegal: outside() as u16,
            overrun: is_set(),
            index: perhaps(latch),
            probe: perhaps(latch),
            home: perhaps(latch),
        }
    }
}

impl Inlet for Pins {
    fn inputs(&self, enable: bool) -> Inputs<'_> {
        Inputs {
            capture: self.capture(),
            enable,
            lines: Lines {
                drive_ready: is_set(),
                drive_fault: is_set(),
                encoder_lost: is_set(),
                emergency_stop: is_set(),
                limit_low: is_set(),
                limit_high: is_set(),
                home: is_set(),
                master_lost: is_set(),
            },
            reference: Reference {
                steps: outside(),
                master: perhaps(|| self.capture()),
                analog: Command::from_bits(outside() as _),
            },
            readback: perhaps(|| Command::from_bits(outside() as _)),
            missed_ticks: outside() as u16,
        }
    }
}

struct Timer;

impl TickTimer for Timer {
    fn since_due(&self) -> u32 {
        outside()
    }

    fn is_due_again(&self) -> bool {
        is_set()
    }
}

#[entry]
fn main() -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}

#[exception]
fn SysTick() {
    let place = outside() as *mut Runtime<AxisControl<Pins>>;
    // SAFETY: the image is not run; the compiler is not to know what is there.
    let runtime = unsafe { &mut *place };
    let pins = Pins([0; 64].map(|_: u32| outside()));
    let report = runtime.run(&Timer, perhaps(|| &pins));
    let (command, enabled) = report.record.drive();
    put(command.to_bits() as u32);
    put(u32::from(enabled));
}

fn perhaps<T>(value: impl FnOnce() -> T) -> Option<T> {
    is_set().then(value)
}

fn latch() -> Latch {
    Latch {
        count: outside(),
        time: outside(),
    }
}

fn is_set() -> bool {
    outside() != 0
}

fn put(word: u32) {
    // SAFETY: `OUTSIDE` is a device register of the board; the image is not run.
    unsafe { write_volatile(OUTSIDE, word) }
}

fn outside() -> u32 {
    // SAFETY: `OUTSIDE` is a device register of the board; the image is not run.
    unsafe { read_volatile(OUTSIDE) }
}

unsafe extern "C" {
    /// Nowhere defined: whoever calls it cannot be linked.
    fn a_panic_is_reachable_from_the_tick() -> !;
}

#[panic_handler]
fn stop(_: &PanicInfo<'_>) -> ! {
    // SAFETY: no image that reaches this is ever linked.
    unsafe { a_panic_is_reachable_from_the_tick() }
}
