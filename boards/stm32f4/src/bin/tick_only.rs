//! The tick and the latches of the board and nothing else, in the profile of the firmware, with a panic that cannot be
//! linked: it links only if no panic can be reached from them.
//!
//! The handlers are those of the firmware. Their state comes from outside, so that neither its making nor its configuration is
//! in the image; `tick_only.x` roots the handlers alone, as others may panic (the HAL's time). With `--features planted-panic`
//! the image must fail to link. `cargo xtask no-panic` builds both. It is built, not run.
#![no_std]
#![no_main]

use core::panic::PanicInfo;

use board_stm32f4::tick::{self, TickState};

/// Gives the tick whatever is there: the compiler is not to know.
///
/// # Safety
/// The image is not run.
// SAFETY: no other item has this name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn adopt_any(state: *const TickState) {
    // SAFETY: by this function's condition.
    tick::adopt(unsafe { state.read() });
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
