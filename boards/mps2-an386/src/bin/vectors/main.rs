//! Vectors for a model of the core: one image that runs as it is in QEMU and on an emulated STM32F4, whose flash is at
//! zero, too, after a reset. Both have to make the same words of it.
//!
//! The words are left in `VECTORS` and their number in `FINISHED`; only then are they logged by semihosting, a line a group:
//! `vectors <group>: <words>`. Where there is none the program ends in a fault: a reader looks at `FINISHED`.
#![no_std]
#![no_main]

mod instructions;
mod memory;
mod portable;
mod single;

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicUsize, Ordering};

use board_mps2_an386::exit_success;
use cortex_m_rt::entry;

use portable::{Make, Words};

/// Words that all groups make together, at most.
const LENGTH: usize = 4096;

/// Groups of what a host has not.
const OWN: &[(&str, Make)] = &[
    ("instructions", instructions::run),
    ("single", single::run),
    ("memory", memory::run),
];

/// Memory that is looked at from outside.
struct Memory(UnsafeCell<[u32; LENGTH]>);

// SAFETY: only the program's main function touches it; it has no interrupts.
unsafe impl Sync for Memory {}

/// The words.
#[unsafe(no_mangle)]
static VECTORS: Memory = Memory(UnsafeCell::new([0; LENGTH]));

/// How many they are, once they are all there.
#[unsafe(no_mangle)]
static FINISHED: AtomicUsize = AtomicUsize::new(0);

#[entry]
fn main() -> ! {
    // SAFETY: the only reference; `main` runs once.
    let memory = unsafe { &mut *VECTORS.0.get() };
    let groups = || OWN.iter().chain(portable::GROUPS);
    let mut ends = [0; OWN.len() + portable::GROUPS.len()];
    let mut words = Words::new(memory);
    for ((_, make), end) in groups().zip(&mut ends) {
        make(&mut words);
        *end = words.used();
    }
    let used = words.used();
    FINISHED.store(used, Ordering::Release);
    let mut start = 0;
    for ((name, _), end) in groups().zip(ends) {
        defmt::info!("vectors {=str}: {:08x}", name, &memory[start..end]);
        start = end;
    }
    exit_success()
}
