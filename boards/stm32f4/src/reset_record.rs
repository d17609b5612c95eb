//! Why the last reset came: the record in RAM that start-up code leaves alone, and the chip's own flags.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering};

use embassy_stm32::pac;
use leadscrew_app::safe_state::reason::Reason;
use leadscrew_app::safe_state::record::{Record, ResetFlags, WORDS};

struct Place(UnsafeCell<MaybeUninit<[u32; WORDS]>>);

// SAFETY: reached by volatile accesses of whole words alone. A writer that comes in between another's words, which only an interrupt
// or a fault does, leaves a mixture that the record's checksum finds.
unsafe impl Sync for Place {}

// SAFETY: the section is of the linker script of cortex-m-rt, in RAM, and not written at start-up. Nothing is assumed of its content:
// any words are words.
#[unsafe(link_section = ".uninit.RESET_RECORD")]
static KEPT: Place = Place(UnsafeCell::new(MaybeUninit::uninit()));
/// Resets that nobody asked for since the power came.
static RESETS: AtomicU32 = AtomicU32::new(0);

/// Why the last reset came; to be called once, first of all. From then on the next reset has no reason until one is kept.
pub fn take() -> Record {
    let csr = pac::RCC.csr().read();
    // The flags add up until they are cleared.
    pac::RCC.csr().modify(|w| w.set_rmvf(true));
    let flags = ResetFlags {
        watchdog: csr.wdgrstf() || csr.wwdgrstf(),
        power: csr.porrstf() || csr.borrstf(),
    };
    let record = Record::after_reset(&read(), flags);
    RESETS.store(record.resets, Ordering::Relaxed);
    write(&record.at_start());
    defmt::info!(
        "reset: power {=bool}, pin {=bool}, software {=bool}, watchdog {=bool}; {=u32} that nobody asked for since the power came",
        flags.power,
        csr.padrstf(),
        csr.sftrstf(),
        flags.watchdog,
        record.resets
    );
    if let Some(reason) = record.reason {
        defmt::error!("the last reset: {}", defmt::Display2Format(&reason));
    }
    record
}

/// Keeps a reason for the next start; the last one counts.
pub fn keep(reason: Reason) {
    write(&now().with(reason));
}

/// Takes a reason back.
pub fn forget() {
    write(&now());
}

fn now() -> Record {
    Record {
        reason: None,
        resets: RESETS.load(Ordering::Relaxed),
    }
}

fn read() -> [u32; WORDS] {
    let words = KEPT.0.get().cast::<u32>();
    // SAFETY: within the place and aligned, as it is an array of words. Volatile: what is there was written by a program before.
    core::array::from_fn(|at| unsafe { words.add(at).read_volatile() })
}

fn write(record: &Record) {
    let place = KEPT.0.get().cast::<u32>();
    for (at, word) in record.words().into_iter().enumerate() {
        // SAFETY: within the place and aligned, as both have so many words. Volatile: who reads it is the program after the reset.
        unsafe { place.add(at).write_volatile(word) };
    }
}
