//! The way in and out of QEMU: command line, exit code, and what a failure leaves behind.

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
use semihosting::experimental::env;
use semihosting::process::ExitCode;

const LONGEST_COMMAND_LINE: usize = 512;

/// The words of QEMU's `-semihosting-config …,arg=…`, the first of them (the image's name) apart.
///
/// Calls `each` for every word until it returns an error. Without a command line there are no words.
pub fn arguments<E>(mut each: impl FnMut(&str) -> Result<(), E>) -> Result<(), E> {
    let Ok(words) = env::args::<LONGEST_COMMAND_LINE>() else {
        defmt::panic!(
            "the command line is longer than {=usize} bytes",
            LONGEST_COMMAND_LINE
        );
    };
    for word in (&words).skip(1) {
        match word {
            Ok(word) => each(word)?,
            Err(_) => defmt::panic!("the command line is not UTF-8"),
        }
    }
    Ok(())
}

/// Ends QEMU with exit code 0.
pub fn exit_success() -> ! {
    ExitCode::SUCCESS.exit_process()
}

/// Ends QEMU with exit code 1.
pub fn exit_failure() -> ! {
    ExitCode::FAILURE.exit_process()
}

/// Starts the program anew, as after power on; what the board kept without power it keeps.
pub fn restart() -> ! {
    cortex_m::interrupt::disable();
    SCB::sys_reset()
}

/// Logs once: a failure inside the logger comes back here and then just ends.
fn fail(log: impl FnOnce()) -> ! {
    static FAILING: AtomicBool = AtomicBool::new(false);
    cortex_m::interrupt::disable();
    if !FAILING.swap(true, Ordering::Relaxed) {
        log();
    }
    exit_failure()
}

#[panic_handler]
fn panicked(info: &PanicInfo<'_>) -> ! {
    fail(|| defmt::error!("{}", defmt::Display2Format(info)))
}

/// `defmt::panic!` has logged already when it comes here.
#[defmt::panic_handler]
fn defmt_panicked() -> ! {
    exit_failure()
}

#[exception]
// SAFETY: the attribute demands it; the handler only reads the frame that the hardware stacked.
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    fail(|| {
        defmt::error!(
            "hard fault at pc {=u32:#010x}, lr {=u32:#010x}",
            frame.pc(),
            frame.lr()
        );
    })
}

#[exception]
// SAFETY: the attribute demands it; the handler touches nothing.
unsafe fn DefaultHandler(line: i16) {
    fail(|| defmt::error!("interrupt {=i16} has no handler", line))
}
