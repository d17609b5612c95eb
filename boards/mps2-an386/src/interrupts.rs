//! The board's interrupt lines and their vector table, in the shape that `cortex_m_rt` expects of a
//! device crate (none is published for this board).

use cortex_m::interrupt::InterruptNumber;
// The attribute of this name expects the enum under the same name beside it.
pub use Interrupt as interrupt;
pub use cortex_m_rt::interrupt;

/// The interrupt lines in use.
#[allow(clippy::upper_case_acronyms)] // handlers bear these names, and they are the manual's
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u16)]
pub enum Interrupt {
    /// UART 0 has a byte.
    UART0RX = 0,
    /// UART 0 has room for a byte.
    UART0TX = 1,
    /// UART 1 has a byte.
    UART1RX = 2,
    /// UART 1 has room for a byte.
    UART1TX = 3,
    /// CMSDK timer 0.
    TIMER0 = 8,
    /// CMSDK timer 1.
    TIMER1 = 9,
    /// The dual timer, one line for both.
    DUALTIMER = 10,
    /// Not wired to anything: pended by software.
    SPARE30 = 30,
}

// SAFETY: each number is the line's position in `__INTERRUPTS` below, and never changes.
unsafe impl InterruptNumber for Interrupt {
    fn number(self) -> u16 {
        self as u16
    }
}

// SAFETY: declared as `device.x` provides them; `cortex_m_rt::interrupt` defines handlers with this
// name and signature.
unsafe extern "C" {
    fn DefaultHandler();
    fn UART0RX();
    fn UART0TX();
    fn UART1RX();
    fn UART1TX();
    fn TIMER0();
    fn TIMER1();
    fn DUALTIMER();
    fn SPARE30();
}

const LINES: usize = 32;

#[doc(hidden)]
// SAFETY: cortex-m-rt's link.x places this section behind the exceptions and keeps it by this name.
#[unsafe(link_section = ".vector_table.interrupts")]
// SAFETY: the name is reserved by cortex-m-rt for the device's vector table, of which there is one.
#[unsafe(no_mangle)]
pub static __INTERRUPTS: [unsafe extern "C" fn(); LINES] = {
    let mut table: [unsafe extern "C" fn(); LINES] = [DefaultHandler; LINES];
    table[Interrupt::UART0RX as usize] = UART0RX;
    table[Interrupt::UART0TX as usize] = UART0TX;
    table[Interrupt::UART1RX as usize] = UART1RX;
    table[Interrupt::UART1TX as usize] = UART1TX;
    table[Interrupt::TIMER0 as usize] = TIMER0;
    table[Interrupt::TIMER1 as usize] = TIMER1;
    table[Interrupt::DUALTIMER as usize] = DUALTIMER;
    table[Interrupt::SPARE30 as usize] = SPARE30;
    table
};
