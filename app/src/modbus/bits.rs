//! Discrete inputs: the bits of the status, and one for each fault and warning.

use leadscrew::supervisor::{Fault, State};

use super::View;

/// First discrete input of the faults: input `FAULTS + n` is on while the fault of number n is latched.
pub const FAULTS: u16 = 100;
/// First discrete input of the warnings: input `WARNINGS + n` is on while the warning of number n stands.
pub const WARNINGS: u16 = 200;
/// Inputs of each of the blocks of faults and warnings; those of numbers that no fault has are off.
pub const NUMBERS: u16 = 32;
/// Inputs of the status, and bits of its register; those that the table does not have are off.
pub const STATUS: u16 = 16;

/// A bit of the status.
#[derive(Clone, Copy, Debug)]
pub struct Bit {
    /// Bit of the register `status`, and discrete input.
    pub number: u16,
    /// Its name.
    pub name: &'static str,
    /// When it is on.
    pub what: &'static str,
    /// Reads it.
    pub get: fn(&View) -> bool,
}

macro_rules! bits {
    ($($number:literal $name:ident: $what:literal, $get:expr;)*) => {
        /// All bits of the status, by number. A number is never used anew.
        pub const BITS: &[Bit] = &[$(Bit {
            number: $number,
            name: stringify!($name),
            what: $what,
            get: $get,
        },)*];
    };
}

bits! {
    0 enabled: "The drive is enabled.", |view| view.seen.enabled;
    1 moving: "A motion is commanded.", |view| view.seen.moving;
    2 homed: "The origin is known.", |view| view.seen.origin.is_some();
    3 held: "A feed hold is on.", |view| view.is_held;
    4 leased: "A tool on the link holds the control lease.", |view| view.is_leased;
    5 planned: "Planned moves are what moves the axis, or may.", |view| view.seen.is_planned;
    6 ready: "The axis is under control: Ready or Moving.",
        |view| matches!(view.seen.state, State::Ready | State::Moving);
    7 faulted: "A fault is latched.", |view| view.seen.fault.is_some();
    8 warned: "A warning stands.", |view| view.seen.warnings != 0;
    9 settable: "The axis is off: parameters can be written.", View::is_off;
    10 probed: "The probe has touched since the start: its registers hold.", |view| view.probe.is_some();
    11 clean: "Every tick was in time, and every record was told.", |view| view.counts.is_clean();
}

/// The register `status`.
#[must_use]
pub fn status(view: &View) -> u16 {
    BITS.iter()
        .filter(|bit| (bit.get)(view))
        .fold(0, |sum, bit| sum | 1 << bit.number)
}

/// The discrete input at `address`, if there is one.
#[must_use]
pub fn discrete(view: &View, address: u16) -> Option<bool> {
    let within = |first: u16, count: u16| {
        let number = address.checked_sub(first)?;
        (number < count).then_some(number)
    };
    if let Some(number) = within(0, STATUS) {
        return Some(status(view) & 1 << number != 0);
    }
    if let Some(number) = within(FAULTS, NUMBERS) {
        let fault = u8::try_from(number).ok().and_then(Fault::from_number);
        return Some(fault.is_some() && fault == view.seen.fault);
    }
    within(WARNINGS, NUMBERS).map(|number| view.seen.warnings & 1 << number != 0)
}
