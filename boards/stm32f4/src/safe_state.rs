//! What a board does that cannot go on: command zero, drive off, brake closed, then a reset.

use core::panic::PanicInfo;

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};

use crate::{converter, lines};

/// Brings the outputs into the safe state; may be called at any time, by whoever found out first.
pub fn enter() {
    lines::release();
    converter::release();
}

/// Starts the firmware anew.
pub fn restart() -> ! {
    cortex_m::interrupt::disable();
    enter();
    SCB::sys_reset();
}

/// Stays in the safe state until the power goes, for a board that cannot be made ready.
pub fn stop(reason: &str) -> ! {
    enter();
    defmt::error!("stopped: {=str}", reason);
    loop {
        cortex_m::asm::wfi();
    }
}

#[panic_handler]
fn on_panic(_: &PanicInfo<'_>) -> ! {
    cortex_m::interrupt::disable();
    enter();
    SCB::sys_reset();
}

// SAFETY: the handler touches nothing of the program's but registers of outputs, which any program state allows.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    enter();
    SCB::sys_reset();
}
