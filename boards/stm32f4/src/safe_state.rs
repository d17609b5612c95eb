//! What a board does that cannot go on: command zero, drive off, brake closed, why it was, then a reset.

use core::panic::PanicInfo;

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
use leadscrew_app::safe_state::reason::{HardFault, Place, Reason};

use crate::{converter, lines, reset_record, watchdog};

/// Brings the outputs into the safe state; may be called at any time, by whoever found out first.
pub fn enter() {
    lines::release();
    converter::release();
}

/// Starts the firmware anew, because somebody asked for it.
pub fn restart() -> ! {
    cortex_m::interrupt::disable();
    enter();
    SCB::sys_reset();
}

/// Starts the firmware anew, which will tell why.
pub fn fail(reason: Reason) -> ! {
    cortex_m::interrupt::disable();
    // First what matters.
    enter();
    reset_record::keep(reason);
    SCB::sys_reset();
}

/// Stays in the safe state until the power goes, for a board that cannot be made ready.
pub fn stop(reason: &str) -> ! {
    // A tick that runs already would put out again what it has.
    cortex_m::interrupt::disable();
    enter();
    defmt::error!("stopped: {=str}", reason);
    loop {
        // It may run already, and a reset would only bring the same again.
        watchdog::feed();
    }
}

/// What the firmware's panic handler does. It is the program's own, as tests on the board have another.
pub fn on_panic(info: &PanicInfo<'_>) -> ! {
    let place = info
        .location()
        .map_or(Place::new("", 0), |at| Place::new(at.file(), at.line()));
    fail(Reason::Panic(place));
}

// SAFETY: the handler touches nothing of the program's but registers of outputs, which any program state allows, and the
// record, which nobody works with in between: the handler does not return.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    // SAFETY: reads of the processor's own registers of faults, which have no effect.
    let (cfsr, hfsr, address) = unsafe {
        let scb = &*SCB::PTR;
        (scb.cfsr.read(), scb.hfsr.read(), scb.bfar.read())
    };
    fail(Reason::HardFault(HardFault {
        pc: frame.pc(),
        lr: frame.lr(),
        cfsr,
        hfsr,
        address,
    }));
}
